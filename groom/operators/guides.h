// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "base/ledger.h"
#include "base/schema.h"
#include "base/value_readers.h"
#include "geom/strands.h"
#include "groom/operators/operator.h"
#include "groom/strands/root_grid.h"
#include "image/field.h"

namespace pelage {

class GuideSet;

/// Keys of the operator `guides`.
struct GuidesParams {
  AssetPath file;
  std::optional<CurveBasis> basis;
  float scale = 1;
  V3f translate{0};
  std::optional<V3f> mirror;
  int neighbours = 4;
  std::optional<float> radius;
  std::optional<float> spread;
  Field amount{1.0f};
  static const Schema<GuidesParams>& schema();
};

/// Shapes a strand like nearby guides: its shape and its length become weighted means of the shapes and
/// lengths of these guides. The shape of a guide consists of its offsets from its root, after the smallest
/// rotation from the guide's root normal to the strand's root normal. A guide at the distance d from the
/// strand's root has the weight (1 - d / R)^2.
///
/// R is the distance of the nearest guide that is not used, but at most the radius. The weight of a guide
/// therefore becomes 0 before another guide takes its place. A strand without a guide within the radius stays
/// unchanged.
///
/// The mean of guides that lean apart would stand upright between them. Therefore a guide counts only as far
/// as it leans like the nearest guide: fully up to 40 degrees, not at all from 60 degrees. So the coat is
/// continuous where nearby guides lean within 40 degrees of each other, and parts where they lean apart. A
/// guide does not count on the other side of a line of the operator `part`.
class Guides final : public OperatorOf<GuidesParams> {
 public:
  static constexpr const char* kName = "guides";
  using OperatorOf::OperatorOf;

  OperatorTraits traits() const override {
    return {.name = kName, .version = 2, .restricts_coverage = params_.spread.has_value(), .may_miss = true};
  }
  void prepare(const PrepareContext& context) override;
  float coverage(const FieldPoint& root) const override;
  bool misses(const FieldPoint& root) const override;
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  bool all_strands_have_guides() const;

  std::shared_ptr<const GuideSet> guides_;
  std::vector<std::shared_ptr<const PartLines>> parts_;
  RootGrid near_;     // finds the guides that shape a strand
  RootGrid covered_;  // finds whether a guide is near enough for a strand to grow (`spread`)
  std::shared_ptr<const MemoryCharge> charge_;  // memory of guides_, near_ and covered_
};

}  // namespace pelage
