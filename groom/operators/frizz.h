// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "groom/operators/operator_of.h"
#include "image/field.h"

namespace pelage {

/// Keys of the operator `frizz`.
struct FrizzParams {
  Field amplitude{0.02f};
  Field frequency{3.0f};
  static const Schema<FrizzParams>& schema();
};

/// Displaces the points of each strand sideways by noise, independently of other strands.
class Frizz final : public OperatorOf<FrizzParams> {
 public:
  static constexpr const char* kName = "frizz";
  using OperatorOf::OperatorOf;

  OperatorTraits traits() const override { return {.name = kName}; }
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  uint64_t seed_ = 0;
};

}  // namespace pelage
