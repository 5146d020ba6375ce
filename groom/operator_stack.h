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

/// The operators of a groom, in order. The live part begins with the first operator that reads live state
/// (the posed skin or posed strands); all operators before it read rest state only. Immutable once prepared.
/// Thread safety: const members may be called from any thread.
class OperatorStack {
 public:
  /// Copies of the operators of the list, not yet prepared.
  explicit OperatorStack(const OperatorList& list);

  /// Prepares each operator of [begin, end) that is not prepared yet. If preparing an operator runs the
  /// preceding operators, prepares these first. Each operator gets a copy of `context` in which `preceding`,
  /// `seed` and `position` are set for this operator. `context.seed` is the seed of the groom.
  void prepare(size_t begin, size_t end, const PrepareContext& context);
  void prepare_all(const PrepareContext& context) { prepare(0, size(), context); }
  /// Prepares the operators that coverage() needs.
  void prepare_coverage(const PrepareContext& context);

  size_t size() const { return operators_.size(); }
  /// The first operator that reads live state; size() when none does.
  size_t first_live() const { return live_; }
  /// The applied operators must have been prepared.
  void apply(size_t begin, size_t end, StrandBatch& batch) const;
  void apply_frozen(StrandBatch& batch) const { apply(0, live_, batch); }
  void apply_live(StrandBatch& batch) const { apply(live_, size(), batch); }
  bool has_live() const { return live_ < operators_.size(); }
  /// Whether attributes_only() holds for all of [begin, end).
  bool attributes_only(size_t begin, size_t end) const;
  /// The max of rest_use() over [begin, end).
  RestUse rest_use(size_t begin, size_t end) const;
  bool needs_closest_point() const;
  /// Whether has_one_width_profile() holds for all of [begin, end).
  bool has_one_width_profile(size_t begin, size_t end) const;
  /// The highest frequency of the colours that operators write; empty when no operator writes colours.
  std::optional<AttributeClass> colors() const { return colors(0, size()); }
  std::span<const std::unique_ptr<Operator>> operators() const { return operators_; }
  /// The same for [begin, end).
  std::optional<AttributeClass> colors(size_t begin, size_t end) const;
  /// Product of the random factors that operators apply to the colour of a strand. `seed`: the seed of the
  /// context passed to prepare().
  Operator::Brightness brightness(uint64_t seed, uint64_t strand_id) const;
  /// Properties of strands after the operators [begin, end). `before`: their properties before these
  /// operators.
  StrandReach reach(StrandReach before, size_t begin, size_t end) const;
  /// Product of the coverage of all operators.
  float coverage(const V3f& rest_position, const V3f& normal) const;
  bool restricts_coverage() const;

 private:
  struct Place {
    SourcePosition position;
    uint64_t name = 0;    // hash of the operator's name
    uint64_t number = 0;  // number of preceding operators with the same name
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
/// Fills batch.current with the roots in a pose.
void place_in_pose(StrandBatch& batch, const LimitSurface& pose, const FollicleTree& follicles, size_t begin);

}  // namespace pelage
