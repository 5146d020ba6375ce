// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "base/schema.h"
#include "groom/operator_of.h"
#include "groom/strand_batch.h"
#include "image/field.h"

namespace pelage {

class ClumpCentres;

/// Keys of a finer level of clumps, inside the clumps of `clump`.
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

/// Pulls strands towards the nearest of a set of centre strands, which are distributed as blue noise on the
/// rest skin and grown by the operators before this one. Finer levels pull towards denser sets, whose strands
/// the coarser levels have already pulled.
///
/// A strand and its centre are matched by arc length, so that strands of unequal length lie together. A
/// strand that clumping would lengthen is scaled back about its root: completely if its length is at least
/// 1.5 times the distance to its centre, otherwise partly. Where a strand and its centre diverge by 30
/// degrees, an amount of 0.5 shortens the strand by 3 %.
class Clump final : public OperatorOf<ClumpParams> {
 public:
  static constexpr const char* kName = "clump";
  using OperatorOf::OperatorOf;

  std::string_view name() const override { return kName; }
  bool runs_preceding() const override { return true; }
  void prepare(const PrepareContext& context) override;
  void apply(StrandBatch& batch) const override;
  float displacement_bound(const StrandReach& before) const override;
  StrandReach reach_after(const StrandReach& before) const override;

 private:
  struct Level {
    float spacing = 0;
    Field amount;
    std::shared_ptr<const ClumpCentres> centres;
  };
  /// How far strands have been pulled, for scaling them back.
  struct PullTotals {
    StrandRow stays;  // product over levels of 1 - largest amount along the strand
    StrandRow roots;  // sum of the distances to their centres' roots
  };
  /// All levels combined: K with 1 - K = product of (1 - k), and the distances of the centres.
  struct Pull {
    float amount = 0;
    float roots = 0;
  };
  void draw(StrandBatch& batch, size_t level_count) const;
  void draw_level(const Level& level, uint64_t level_seed, const std::vector<StrandRow>& arcs,
                  StrandBatch& batch, PullTotals& totals) const;
  float strongest(const Level& level) const;
  Pull pull() const;

  uint64_t seed_ = 0;
  std::vector<Level> levels_;
};

}  // namespace pelage
