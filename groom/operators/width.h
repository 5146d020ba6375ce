// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "groom/operators/operator_of.h"
#include "image/field.h"

namespace pelage {

/// Keys of the operator `width`. Widths are diameters in scene units.
struct WidthParams {
  Field root{0.01f};
  Field tip{0.001f};
  float profile = 1;
  float variation = 0;
  static const Schema<WidthParams>& schema();
};

/// Sets the widths of strands, from root to tip.
class Width final : public OperatorOf<WidthParams> {
 public:
  static constexpr const char* kName = "width";
  using OperatorOf::OperatorOf;

  OperatorTraits traits() const override;
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  uint64_t seed_ = 0;
};

}  // namespace pelage
