// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geom/limit_surface.h"
#include "groom/follicles/follicles.h"
#include "groom/operators/operator.h"
#include "groom/operators/operator_list.h"
#include "groom/strands/strand_batch.h"

namespace pelage {

/// The operators of a groom, in order. The first operator that reads live state (the posed skin or posed
/// strands) and all operators after it form the live part. All operators before it read rest state only.
/// Immutable once prepared. Thread safety: const members may be called from any thread.
class OperatorStack {
 public:
  /// Copies the operators of a list. The copies are not yet prepared.
  explicit OperatorStack(const OperatorList& list);

  /// Prepares each operator of [begin, end) that is not prepared yet. If preparing an operator runs the
  /// operators before it, prepares these first. Prepares all operators that part hair before any other.
  /// Each operator receives a copy of `context` with its own `preceding`, `seed` and `position`, and with the
  /// `parts` of the groom. `context.seed` is the seed of the groom.
  void prepare(size_t begin, size_t end, const PrepareContext& context);
  void prepare_all(const PrepareContext& context) { prepare(0, size(), context); }
  /// Warns once for each prepared operator that misses strands, with the number of these strands. If there
  /// are very many strands, estimates the number from a sample.
  void warn_of_missed(const LimitSurface& rest, const FollicleTree& follicles,
                      const PrepareContext& context) const;
  /// Prepares the operators that coverage() calls.
  void prepare_coverage(const PrepareContext& context);

  size_t size() const { return operators_.size(); }
  /// Index of the first operator that reads live state; size() when there is none.
  size_t first_live() const { return live_; }
  /// Applies the operators [begin, end), which must have been prepared.
  void apply(size_t begin, size_t end, StrandBatch& batch) const;
  void apply_frozen(StrandBatch& batch) const { apply(0, live_, batch); }
  void apply_live(StrandBatch& batch) const { apply(live_, size(), batch); }
  bool has_live() const { return live_ < operators_.size(); }
  /// Returns what the operators [begin, end) need and do together, as if they were one operator. The result
  /// has no name, version or runs_preceding.
  OperatorTraits traits(size_t begin, size_t end) const;
  OperatorTraits traits() const { return traits(0, size()); }
  std::span<const std::unique_ptr<Operator>> operators() const { return operators_; }
  /// Returns the product of the random factors that operators apply to the colour of a strand. `seed`: the
  /// seed of the context that was passed to prepare().
  Operator::Brightness brightness(uint64_t seed, uint64_t strand_id) const;
  /// Returns the bounds of strands after the operators [begin, end). `before`: their bounds before these
  /// operators.
  StrandReach reach(StrandReach before, size_t begin, size_t end) const;
  /// Returns the product of the coverage of all operators.
  float coverage(const FieldPoint& root) const;

 private:
  struct Place {
    SourcePosition position;
    uint64_t name = 0;    // hash of the operator's name
    uint64_t number = 0;  // number of preceding operators with the same name
    bool prepared = false;
  };
  uint64_t seed_of(uint64_t groom, size_t i) const;
  void prepare_one(size_t i, const PrepareContext& context);

  std::vector<std::unique_ptr<Operator>> operators_;
  std::vector<OperatorTraits> traits_;  // of each operator
  std::vector<Place> places_;
  size_t live_ = 0;  // first operator that reads live state
};

/// Sets the rest roots, ids and texture coordinates of a batch: follicles [begin, begin + batch.count).
void place_on_rest(StrandBatch& batch, const LimitSurface& rest, const FollicleTree& follicles, size_t begin);
/// Sets only the ids, texture coordinates and faces of follicles [begin, begin + batch.count).
void place_ids(StrandBatch& batch, const SurfaceTopology& topology, const FollicleTree& follicles,
               size_t begin);
/// Sets batch.current to the roots of follicles [begin, begin + batch.count) in a pose.
void place_in_pose(StrandBatch& batch, const LimitSurface& pose, const FollicleTree& follicles, size_t begin);

}  // namespace pelage
