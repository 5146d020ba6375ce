// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "groom/operator.h"
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

/// Lays strands over in a direction along the skin. Keeps every segment's length.
class Comb final : public Operator {
 public:
  using Params = CombParams;
  static constexpr const char* kName = "comb";
  explicit Comb(Params params) : params_(std::move(params)) {}

  std::string_view name() const override { return kName; }
  std::vector<ParameterText> parameters() const override { return Params::schema().describe(params_); }
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  float displacement_bound(const StrandReach& before) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  float largest_turn(const StrandReach& before) const;

  Params params_;
};

}  // namespace pelage
