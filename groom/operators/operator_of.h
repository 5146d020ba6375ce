// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "groom/operators/operator.h"

namespace pelage {

/// An operator whose keys in the scene file are described by `P`, a struct with a Schema.
template <class P>
class OperatorOf : public Operator {
 public:
  using Params = P;
  explicit OperatorOf(P params) : params_(std::move(params)) {}
  std::vector<ParameterText> parameters() const override { return P::schema().describe(params_); }

 protected:
  P params_;
};

}  // namespace pelage
