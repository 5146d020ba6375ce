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

/// The prepared operators of a groom, in order: first those that read rest state only, then, from the first
/// that reads live state on, the live part. Immutable once prepared. Thread safety: const members may be
/// called from any thread.
class OperatorStack {
 public:
  /// `preceding` of `context` is filled in for each operator.
  OperatorStack(const OperatorList& list, const PrepareContext& context);

  void apply_frozen(StrandBatch& batch) const { apply(0, live_, batch); }
  void apply_live(StrandBatch& batch) const { apply(live_, operators_.size(), batch); }
  bool has_live() const { return live_ < operators_.size(); }
  bool needs_closest_point() const;
  /// The most frequent of the operators'; nothing when none colours strands.
  std::optional<AttributeClass> colors() const;
  std::span<const std::unique_ptr<Operator>> operators() const { return operators_; }
  /// What holds of strands after all operators when `before` held before.
  StrandReach reach(StrandReach before) const;
  /// Product over the operators.
  float coverage(const V3f& rest_position, const V3f& normal) const;
  bool restricts_coverage() const;
  size_t bytes() const;

 private:
  void apply(size_t begin, size_t end, StrandBatch& batch) const;

  std::vector<std::unique_ptr<Operator>> operators_;
  size_t live_ = 0;  // first operator that reads live state
};

/// Fills the rest roots, ids and texture coordinates of follicles [begin, begin + batch.count).
void place_on_rest(StrandBatch& batch, const LimitSurface& rest, const FollicleTree& follicles, size_t begin);
/// Fills batch.here with the roots in a pose.
void place_in_pose(StrandBatch& batch, const LimitSurface& pose, const FollicleTree& follicles, size_t begin);

}  // namespace pelage
