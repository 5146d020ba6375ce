// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "groom/operators/operator_of.h"
#include "image/field.h"

namespace pelage {

/// Keys of the operator `color`.
struct ColorParams {
  Field value{Rgb(0.5f)};
  float variation = 0;
  static const Schema<ColorParams>& schema();
};

/// Colours strands by setting the attribute "color", which materials may read.
class Color final : public OperatorOf<ColorParams> {
 public:
  static constexpr const char* kName = "color";
  using OperatorOf::OperatorOf;

  OperatorTraits traits() const override;
  Brightness brightness(uint64_t seed, uint64_t strand_id) const override;
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override { return before; }

 private:
  uint64_t seed_ = 0;
};

}  // namespace pelage
