// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "base/schema.h"
#include "groom/operators/operator.h"
#include "groom/strands/strand_batch.h"
#include "image/field.h"

namespace pelage {

class ClumpCentres;

/// Keys of an additional, finer level of clumps within the clumps of the operator `clump`.
struct ClumpLevelParams {
  float spacing = 0.1f;
  Field amount{0.5f};
  static const Schema<ClumpLevelParams>& schema();
};

/// Keys of the operator `clump`.
struct ClumpParams {
  float spacing = 0.5f;
  Field amount{0.5f};
  float root = 0;
  float tip = 1;
  float profile = 1;
  float variation = 0;
  float strays = 0;
  std::vector<ClumpLevelParams> levels;
  static const Schema<ClumpParams>& schema();
};

/// Pulls each strand towards the nearest of a set of centre strands. The roots of centre strands are blue
/// noise on the rest skin; the operators before this one grow them. Each finer level has its own, denser set
/// of centre strands. The coarser levels have already pulled these centre strands as well.
///
/// A centre strand does not count on the other side of a line of the operator `part`. A strand that finds
/// none on its side joins no clump.
///
/// Points of a strand and of its centre strand are matched by arc length, so that strands of unequal length
/// lie together. A strand that pulling has made longer is scaled down about its root. It gets its previous
/// length again if this length is at least 1.5 times the distance to its centre; otherwise, it stays somewhat
/// longer. Where a strand and its centre strand diverge by 30 degrees, an amount of 0.5 shortens the strand
/// by 3 %.
class Clump final : public OperatorOf<ClumpParams> {
 public:
  static constexpr const char* kName = "clump";
  using OperatorOf::OperatorOf;

  OperatorTraits traits() const override { return {.name = kName, .runs_preceding = true}; }
  void prepare(const PrepareContext& context) override;
  /// The same as prepare() for a clump that is part of the operator `name`. `shape`: what this operator does
  /// to strands before they are pulled together; may be empty.
  void prepare_after(const PrepareContext& context, const char* name,
                     const std::function<void(StrandBatch&)>& shape);
  void apply(StrandBatch& batch) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  struct Level {
    float spacing = 0;
    Field amount;
    std::shared_ptr<const ClumpCentres> centres;
  };
  /// How far each strand of a batch has been pulled so far; needed to scale the strands back.
  struct PullTotals {
    StrandRow stays;  // product over the levels of 1 - max amount along the strand
    StrandRow roots;  // sum over the levels of the distance from the strand's root to its centre's root
  };
  /// Max pull of all levels together.
  struct Pull {
    float amount = 0;  ///< 1 - product over the levels of (1 - the level's max amount)
    float roots = 0;   ///< sum over the levels of the max distance from a root to its centre's root
  };
  void pull(StrandBatch& batch, size_t level_count) const;
  void pull_level(const Level& level, uint64_t level_seed, const std::vector<StrandRow>& arcs,
                  StrandBatch& batch, PullTotals& totals) const;
  float strongest(const Level& level) const;
  Pull pull() const;

  uint64_t seed_ = 0;
  std::vector<Level> levels_;
  std::vector<std::shared_ptr<const PartLines>> parts_;
};

}  // namespace pelage
