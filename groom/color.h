// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/schema.h"
#include "groom/operator_of.h"
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

  std::string_view name() const override { return kName; }
  std::optional<AttributeClass> colors() const override;
  Brightness brightness(uint64_t seed, uint64_t strand_id) const override;
  bool replaces_colors() const override { return !params_.value.dependence().attributes; }
  bool attributes_only() const override { return true; }
  RestUse rest_use() const override {
    return params_.value.dependence().rest ? RestUse::kPositions : RestUse::kNone;
  }
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  float displacement_bound(const StrandReach&) const override { return 0; }
  StrandReach reach_after(const StrandReach& before) const override { return before; }

 private:
  uint64_t seed_ = 0;
};

}  // namespace pelage
