// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "groom/operator.h"
#include "image/field.h"

namespace pelage {

/// Keys of the operator `curl`.
struct CurlParams {
  Field radius{0.05f};
  Field turns{2.0f};
  float random = 1;
  float start = 0.25f;
  static const Schema<CurlParams>& schema();
};

/// Winds each strand into a helix about itself.
class Curl final : public Operator {
 public:
  using Params = CurlParams;
  static constexpr const char* kName = "curl";
  explicit Curl(Params params) : params_(std::move(params)) {}

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
