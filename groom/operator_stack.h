// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geom/limit_surface.h"
#include "groom/follicles.h"
#include "groom/operator.h"
#include "groom/operator_list.h"
#include "groom/strand_batch.h"

namespace pelage {

/// The operators of a groom, in order: first those that read rest state only, then, from the first that reads
/// live state on, the live part. Immutable once prepared. Thread safety: const members may be called from any
/// thread.
class OperatorStack {
 public:
  /// Copies of the operators of the list, not yet prepared.
  explicit OperatorStack(const OperatorList& list);

  /// Prepares the operators [begin, end) that are not, after those before them that they learn from.
  /// `preceding`, `seed` (of the groom here) and `position` of the context are filled in for each.
  void prepare(size_t begin, size_t end, const PrepareContext& context);
  void prepare_all(const PrepareContext& context) { prepare(0, size(), context); }
  /// Prepares what coverage() asks.
  void prepare_coverage(const PrepareContext& context);

  size_t size() const { return operators_.size(); }
  /// The first operator that reads live state; size() when none does.
  size_t first_live() const { return live_; }
  /// Those that are applied must have been prepared.
  void apply(size_t begin, size_t end, StrandBatch& batch) const;
  void apply_frozen(StrandBatch& batch) const { apply(0, live_, batch); }
  void apply_live(StrandBatch& batch) const { apply(live_, size(), batch); }
  bool has_live() const { return live_ < operators_.size(); }
  /// Whether all of [begin, end) are.
  bool attributes_only(size_t begin, size_t end) const;
  /// The most that any of [begin, end) reads.
  RestUse rest_use(size_t begin, size_t end) const;
  bool needs_closest_point() const;
  /// Whether all of [begin, end) do.
  bool has_one_width_profile(size_t begin, size_t end) const;
  /// The most frequent of the operators'; nothing when none colours strands.
  std::optional<AttributeClass> colors() const { return colors(0, size()); }
  std::span<const std::unique_ptr<Operator>> operators() const { return operators_; }
  /// The same of [begin, end).
  std::optional<AttributeClass> colors(size_t begin, size_t end) const;
  /// The product of what operators multiply the colour of a strand by at random. `seed` is that of the
  /// context that prepare() gets.
  Operator::Brightness brightness(uint64_t seed, uint64_t strand_id) const;
  /// What holds of strands after the operators [begin, end) when `before` held before.
  StrandReach reach(StrandReach before, size_t begin, size_t end) const;
  /// Product over the operators.
  float coverage(const V3f& rest_position, const V3f& normal) const;
  bool restricts_coverage() const;

 private:
  struct Place {
    SourcePosition position;
    uint64_t name = 0;    // hash of the operator's name
    uint64_t number = 0;  // how many of its name stand before it
    bool prepared = false;
  };
  uint64_t seed_of(uint64_t groom, size_t i) const;

  std::vector<std::unique_ptr<Operator>> operators_;
  std::vector<Place> places_;
  size_t live_ = 0;  // first operator that reads live state
};

/// Fills the rest roots, ids and texture coordinates of follicles [begin, begin + batch.count).
void place_on_rest(StrandBatch& batch, const LimitSurface& rest, const FollicleTree& follicles, size_t begin);
/// Fills ids and texture coordinates only.
void place_ids(StrandBatch& batch, const SurfaceTopology& topology, const FollicleTree& follicles,
               size_t begin);
/// Fills batch.here with the roots in a pose.
void place_in_pose(StrandBatch& batch, const LimitSurface& pose, const FollicleTree& follicles, size_t begin);

}  // namespace pelage
