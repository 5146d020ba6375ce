// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "groom/groom_params.h"
#include "groom/operator_stack.h"

namespace pelage {

/// One step of how a coat comes about, with everything that enters there, as text: what a change of it looks
/// like to a person.
struct GroomStage {
  std::string name;  ///< "skin", "strands", "points", or that of an operator
  std::vector<std::pair<std::string, std::string>> inputs;  ///< "amount", "0.6"
  ContentHash hash;                                         ///< of this stage and all before it
};

/// What the strands of a groom are made from, step by step: skin, strands, points, then each operator. Equal
/// hashes mean equal strands. Files enter by their contents, whatever folder they are in.
class GroomIdentity {
 public:
  static constexpr size_t kSkin = 0, kStrands = 1, kPoints = 2, kFirstOperator = 3;

  /// `seed` is that of the groom with its name mixed in. Files that cannot be read enter as such: whoever
  /// needs them will say so.
  GroomIdentity(const GroomParams& params, uint64_t seed, const OperatorStack& stack,
                const LimitSurface* rest);

  const std::vector<GroomStage>& stages() const { return stages_; }
  const GroomStage& of_operator(size_t i) const { return stages_[kFirstOperator + i]; }
  /// Of all operators.
  const ContentHash& whole() const { return stages_.back().hash; }

 private:
  void add(std::string name, const std::vector<ParameterText>& parameters);

  std::vector<GroomStage> stages_;
};

}  // namespace pelage
