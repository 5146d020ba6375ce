// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "base/ledger.h"
#include "base/schema.h"
#include "base/value_readers.h"
#include "geom/strands.h"
#include "groom/operator_of.h"
#include "groom/root_grid.h"
#include "image/field.h"

namespace pelage {

class GuideSet;

/// Keys of the operator `guides`.
struct GuidesParams {
  AssetPath file;
  std::optional<CurveBasis> basis;
  float scale = 1;
  V3f translate{0};
  int neighbours = 4;
  std::optional<float> radius;
  std::optional<float> spread;
  Field amount{1.0f};
  static const Schema<GuidesParams>& schema();
};

/// Gives a strand the weighted mean of the shapes of nearby guides, and the weighted mean of their lengths.
/// The shape of a guide is its offsets from its root, after the smallest rotation from the guide's root
/// normal to the strand's root normal. A guide at the distance d has the weight (1 - d / R)^2.
///
/// R is the distance of the nearest guide that is not used, or the radius if the radius is smaller. The coat
/// is therefore continuous where the set of nearest guides changes. A strand without a guide within the
/// radius stays unchanged.
class Guides final : public OperatorOf<GuidesParams> {
 public:
  static constexpr const char* kName = "guides";
  using OperatorOf::OperatorOf;

  std::string_view name() const override { return kName; }
  void prepare(const PrepareContext& context) override;
  float coverage(const V3f& rest_position, const V3f& normal) const override;
  bool restricts_coverage() const override { return params_.spread.has_value(); }
  void apply(StrandBatch& batch) const override;
  float displacement_bound(const StrandReach& before) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  bool all_strands_have_guides() const;

  std::shared_ptr<const GuideSet> guides_;
  RootGrid near_;                               // for interpolation
  RootGrid covered_;                            // for coverage
  std::shared_ptr<const MemoryCharge> charge_;  // of all three
};

}  // namespace pelage
