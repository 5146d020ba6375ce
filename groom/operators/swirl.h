// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/schema.h"
#include "groom/operators/operator.h"
#include "image/field.h"

namespace pelage {

/// Keys of the operator `swirl`.
struct SwirlParams {
  V3f center{0};
  float radius = 1;
  Field angle{60.0f};
  Field lift{0.3f};
  Field amount{1.0f};
  float curve = 0;
  static const Schema<SwirlParams>& schema();
};

/// Combs strands around a point of the rest skin: a whorl, a cowlick or a rosette. Preserves the length of
/// every segment. The turn is complete up to half the radius and falls to 0 at the radius, and where the skin
/// turns away from its normal at the centre by 60 to 90 degrees. At the centre itself, strands stand upright.
class Swirl final : public OperatorOf<SwirlParams> {
 public:
  static constexpr const char* kName = "swirl";
  using OperatorOf::OperatorOf;

  OperatorTraits traits() const override { return {.name = kName}; }
  /// Throws Error (kInput) for skins whose faces are all holes.
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  V3f center_{0}, normal_{0, 0, 1};  // on the rest skin
};

}  // namespace pelage
