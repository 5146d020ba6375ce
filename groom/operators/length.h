// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/schema.h"
#include "groom/operators/operator.h"
#include "image/field.h"

namespace pelage {

/// Keys of the operator `length`.
struct LengthParams {
  std::optional<Field> value;
  Field scale{1.0f};
  Field add{0.0f};
  float variation = 0;
  static const Schema<LengthParams>& schema();
};

/// Scales each strand about its root to a given length.
class Length final : public OperatorOf<LengthParams> {
 public:
  static constexpr const char* kName = "length";
  using OperatorOf::OperatorOf;

  OperatorTraits traits() const override { return {.name = kName}; }
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  uint64_t seed_ = 0;
};

}  // namespace pelage
