// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "groom/operators/operator.h"
#include "image/field.h"

namespace pelage {

/// Keys of the operator `bend`.
struct BendParams {
  Field direction{Rgb(0, -1, 0)};
  Field angle{45.0f};
  float start = 0;
  float profile = 1;
  float variation = 0;
  Field amount{1.0f};
  static const Schema<BendParams>& schema();
};

/// Bends strands towards a direction. The bend increases from root to tip. Preserves the length of every
/// segment.
class Bend final : public OperatorOf<BendParams> {
 public:
  static constexpr const char* kName = "bend";
  using OperatorOf::OperatorOf;

  OperatorTraits traits() const override { return {.name = kName}; }
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  float largest_angle() const;  // radians

  uint64_t seed_ = 0;
};

}  // namespace pelage
