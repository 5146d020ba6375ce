// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "groom/operators/operator.h"
#include "image/field.h"

namespace pelage {

/// Keys of the operator `comb`.
struct CombParams {
  Field direction{Rgb(0, -1, 0)};
  Field lift{0.3f};
  Field amount{1.0f};
  float curve = 0;
  static const Schema<CombParams>& schema();
};

/// Tilts strands towards a direction along the skin. Preserves the length of every segment.
class Comb final : public OperatorOf<CombParams> {
 public:
  static constexpr const char* kName = "comb";
  using OperatorOf::OperatorOf;

  OperatorTraits traits() const override { return {.name = kName}; }
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;
};

}  // namespace pelage
