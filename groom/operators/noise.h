// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "groom/operators/operator_of.h"
#include "image/field.h"

namespace pelage {

/// Keys of the operator `noise`.
struct NoiseParams {
  Field amplitude{0.1f};
  float frequency = 1;
  float along = 1;
  float profile = 1;
  static const Schema<NoiseParams>& schema();
};

/// Displaces strands by noise that is continuous over the rest skin, so that neighbouring strands move
/// together.
class Noise final : public OperatorOf<NoiseParams> {
 public:
  static constexpr const char* kName = "noise";
  using OperatorOf::OperatorOf;

  OperatorTraits traits() const override { return {.name = kName}; }
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  uint32_t seed_ = 0;
};

}  // namespace pelage
