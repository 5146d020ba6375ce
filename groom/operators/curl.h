// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "groom/operators/operator_of.h"
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

/// Winds each strand into a helix around its previous shape.
class Curl final : public OperatorOf<CurlParams> {
 public:
  static constexpr const char* kName = "curl";
  using OperatorOf::OperatorOf;

  OperatorTraits traits() const override { return {.name = kName}; }
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  uint64_t seed_ = 0;
};

}  // namespace pelage
