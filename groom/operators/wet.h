// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "groom/operators/clump.h"
#include "groom/operators/operator.h"
#include "image/field.h"

namespace pelage {

/// Keys of the operator `wet`.
struct WetParams {
  float spacing = 0.3f;
  Field gather{0.9f};
  float profile = 1;
  float strays = 0.02f;
  Field gravity{Rgb(0, -1, 0)};
  Field weight{40.0f};
  Field flatten{0.5f};
  Field amount{1.0f};
  static const Schema<WetParams>& schema();
};

/// Wet hair. Lays each strand down along the skin, bends it towards gravity, but not into the skin, and then
/// gathers the tips in clumps (Clump). Laying down and bending preserve the length of every segment.
class Wet final : public OperatorOf<WetParams> {
 public:
  static constexpr const char* kName = "wet";
  explicit Wet(WetParams params);

  OperatorTraits traits() const override { return {.name = kName, .runs_preceding = true}; }
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  void weigh_down(StrandBatch& batch) const;
  StrandReach weighed_down(const StrandReach& before) const;

  Clump clumps_;
};

}  // namespace pelage
