// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "groom/operators/operator.h"
#include "image/field.h"

namespace pelage {

/// The keys `mask` and `amount`, which every operator has beside its own keys.
struct MaskParams {
  Field mask{1.0f};
  Field amount{1.0f};
  static const Schema<MaskParams>& schema();
  /// Without `amount`: for operators with an `amount` of their own.
  static const Schema<MaskParams>& mask_only();
};

/// Another operator whose effect is blended in by a mask: points, radii and colours are interpolated linearly
/// between the strand before and after the operator. A point where the mask is 0 keeps its bits, and a point
/// where it is 1 gets the bits of the operator.
class MaskedOperator final : public Operator {
 public:
  using Clone = std::unique_ptr<Operator> (*)(const Operator&);
  /// `clone`: copies `inner`.
  MaskedOperator(std::shared_ptr<const Operator> inner, Clone clone, Field mask);
  MaskedOperator(const MaskedOperator& other);

  /// Those of the masked operator, except for what a mask that varies over the skin or along strands changes.
  OperatorTraits traits() const override;
  std::vector<ParameterText> parameters() const override;
  void prepare(const PrepareContext& context) override;
  /// Interpolates between 1 and the coverage of the masked operator. Attributes of strands count as 0,
  /// because strands have none before they grow.
  float coverage(const FieldPoint& root) const override;
  std::shared_ptr<const PartLines> part() const override { return inner_->part(); }
  bool misses(const FieldPoint& root) const override;
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  std::unique_ptr<Operator> inner_;
  Clone clone_;
  Field mask_;
};

}  // namespace pelage
