// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/content_store.h"
#include "base/ledger.h"
#include "geom/closest_point.h"
#include "geom/io/strand_file.h"
#include "geom/limit_surface.h"
#include "geom/strand_counts.h"
#include "geom/strands.h"
#include "groom/coat/groom_params.h"
#include "groom/follicles/follicles.h"
#include "groom/strands/guide_turns.h"

namespace pelage {

class GrowthCache;
class OperatorScripts;
struct FieldSources;
struct GroomCacheReport;
struct MovingGuides;
struct Job;

/// A skin in the pose of a frame. It has one limit surface per motion key, and one tree over the tessellation
/// of each.
struct PosedSkin {
  std::span<const LimitSurface> keys;  ///< empty for a groom without a skin
  /// Empty when no operator needs to find closest points on the skin.
  std::span<const ClosestPointTree> trees;
  float scale = 1;  ///< uniform scale of the character, applied to strands about their roots
  /// For strands without a skin: one transform per motion key. If empty, the strands keep the positions in
  /// their file.
  std::span<const M44f> free_transforms;
  float length = 1;          ///< scale of the finished strands about their roots, excluding their widths
  bool shown = false;        ///< whether this is the pose of a frame, in which simulated coats have moved
  bool guides_only = false;  ///< whether growth ends where `dynamics` would move the strands
  /// How the guides of a coat are turned, one per motion key; empty: not at all. Set by Groom::grow().
  std::span<const GuideTurns> turns = {};
};

/// The simulated motion of one coat in one frame. Immutable.
struct CoatMotion {
  /// At frame - 1/2, at each motion key of the shutter, and at frame + 1/2.
  std::vector<GuideTurns> keys;
  ContentHash hash;  ///< of what the motion depends on
  MemoryCharge charge;

  /// Returns the turns at the keys of a pose of the shutter, or of the whole frame.
  std::span<const GuideTurns> at_keys(size_t count) const;
};

/// The strands of a leaf to grow, and how level of detail modifies each of them.
struct KeptStrands {
  std::span<const uint32_t> strands;  ///< indices in the leaf, ascending
  std::span<const float> width;       ///< for each strand: factor on its width
  /// For each strand: factor on the deviation of its colour from the mean colour; or empty.
  std::span<const float> contrast;
};

/// A strand after one step of its growth, as Groom::grow_steps() returns it.
struct GrowthStep {
  std::string name;  ///< "follicle" before the first operator, otherwise the name of the operator
  Strands strand;    ///< one strand with one motion key, in world space; at the last step, as grow() makes it
};

/// A coat on a skin: follicles and the operators that shape their strands.
///
/// Operators that only read rest state run on the rest surface. The follicle frames carry the result to each
/// pose: a point becomes root + frame * offset * scale. The first operator that reads live state, and all
/// operators after it, run on the posed strands of every motion key.
///
/// With `cache:`, the result of all operators up to the one named by `freeze` is quantised
/// (groom/cache/frozen_leaf.h) and stored in files. Strands are then always grown from the quantised data,
/// whether it was just computed or read from a file. Every strand is a pure function of the groom, the
/// strand's id and the pose (law 1).
///
/// Strands of a file grow in the same way. Their points are the state before the first operator, their ids
/// are their order in the file, and their roots are the nearest points of the rest skin.
///
/// Immutable. Thread safety: const members may be called from any thread.
class Groom {
 public:
  /// Places follicles and prepares the operators, for example clump centres and guides. `name` is for
  /// messages. `rest` is null for a groom without a skin. `sources`: what fields are loaded from. Throws
  /// Error: kInput for missing maps, missing guide files and invalid combinations; kMemory before making
  /// anything for which the ledger has no room; kStopped when the job is stopped. A problem with the cache
  /// does not stop growing; it is reported as a warning to the job's progress.
  ///
  /// `previous`, if not null: a groom whose follicles are shared if they are the same. `growth_cache`, if not
  /// null: where follicles are kept between runs. Neither is used with a cache in `params`. `scripts`: runs
  /// the functions of operators `python`; null: a groom with such an operator is an error.
  static std::shared_ptr<const Groom> create(const std::string& name, const GroomParams& params,
                                             std::shared_ptr<const LimitSurface> rest,
                                             const FieldSources& sources, const Job& job,
                                             const Groom* previous = nullptr,
                                             const GrowthCache* growth_cache = nullptr,
                                             const OperatorScripts* scripts = nullptr);
  ~Groom();
  /// Returns the coat as it moves in a frame. It shares everything but the motion.
  std::shared_ptr<const Groom> moved(std::shared_ptr<const CoatMotion> motion) const;

  const FollicleTree& follicles() const;
  StrandRole role() const;
  bool needs_closest_point() const;
  /// Whether guides need closest points of the skin before `dynamics` moves them.
  bool guides_need_closest_point() const;
  /// Hash of everything that shapes the strands, including live operators and the versions of the code.
  /// Grooms with equal hashes grow equal strands in equal leaves.
  const ContentHash& content_hash() const;
  /// Hash of everything that shapes the strands, without their division into leaves and their motion.
  const ContentHash& identity() const;
  /// Guides of `dynamics`. Null for a groom without it.
  const MovingGuides* guides() const;
  /// Number of points of a strand that is not imported.
  int points() const;
  /// Store for data that is derived from the groom. Null for a groom without a cache.
  const ContentStore* store() const;
  /// State of the cache when the groom was made (groom/cache/cache_report.h). Null for a groom without a
  /// cache.
  const GroomCacheReport* cache_report() const;
  /// Counts of the repairs made to the strands of the file; zeros for a groom without a file.
  StrandRepairs repairs() const;

  /// Grows all strands of a leaf in a pose, in ascending order of ids. If an operator colours strands, they
  /// have the attribute "color" with 3 components. Its frequency is the lowest that can represent the
  /// colours: constant, per strand or per point. With `kept`, grows only the strands in `kept`, but costs as
  /// much as growing every strand up to the last of these.
  Strands grow(size_t leaf, const PosedSkin& pose, const KeptStrands* kept = nullptr) const;

  using GuideVisit = std::function<void(size_t guide, const Strands& strands, size_t strand)>;
  /// Grows the guides of `dynamics` in a pose and visits each of them once, in an arbitrary order.
  void visit_guides(const PosedSkin& pose, const GuideVisit& visit) const;

  /// Returns a strand after each step of its growth, in the pose of the first motion
  /// key. Not for a groom with a cache, which keeps only the result of its frozen operators.
  std::vector<GrowthStep> grow_steps(size_t follicle, const PosedSkin& pose) const;

  /// Returns the exact size of the result of grow(), for the whole leaf or for its first `count` strands.
  /// Does not set the number of motion keys, because it depends on the pose.
  StrandCounts counts(size_t leaf, size_t count = SIZE_MAX) const;

  bool grows_on_skin() const;
  /// Returns the root of a strand at a motion key. Without a skin, the result has no derivatives.
  SurfacePoint root(size_t follicle, const PosedSkin& pose, size_t key) const;
  /// Returns a number that is uniformly distributed over [0, 1) and depends only on the strand's id. When
  /// detail is reduced, strands with smaller numbers are kept longer. If has_priority_order(), the numbers
  /// ascend within each leaf.
  float priority(size_t follicle) const;
  bool has_priority_order() const;
  /// Upper bound of the distance from the root of a strand to any point of it, plus the radius at that point.
  /// For a character of scale 1.
  float reach() const;
  /// Approximate width of the widest strands, for a character of scale 1. Does not depend on how the coat is
  /// divided into leaves.
  float width() const;
  /// Returns a box that contains all points of the strands that grow() can return, plus their radii. Computes
  /// the box from the roots in the pose, the longest strand and the bounds of each operator, without growing
  /// strands. With `count`, the box is for the first `count` strands of the leaf.
  Box3f conservative_bound(size_t leaf, const PosedSkin& pose, size_t count = SIZE_MAX) const;

 private:
  struct Impl;
  Groom(std::shared_ptr<const Impl> impl, const ContentHash& hash);
  /// Grows the guides at rest and stores their tips.
  void find_tips() const;

  std::shared_ptr<const Impl> impl_;
  std::shared_ptr<const CoatMotion> motion_;  // null: as groomed
  ContentHash hash_;
};

}  // namespace pelage
