// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/schema.h"
#include "groom/operator.h"
#include "image/field.h"

namespace pelage {

/// Keys of the operator `length`.
struct LengthParams {
  std::optional<Field> value;
  Field scale{1.0f};
  float variation = 0;
  static const Schema<LengthParams>& schema();
};

/// Scales each strand about its root until it is as long as asked.
class Length final : public Operator {
 public:
  using Params = LengthParams;
  static constexpr const char* kName = "length";
  explicit Length(Params params) : params_(std::move(params)) {}

  std::string_view name() const override { return kName; }
  std::vector<ParameterText> parameters() const override { return Params::schema().describe(params_); }
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  float displacement_bound(const StrandReach& before) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  Params params_;
  uint64_t seed_ = 0;
};

}  // namespace pelage
