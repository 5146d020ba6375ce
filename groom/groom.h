// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>

#include "base/content_store.h"
#include "base/ledger.h"
#include "geom/closest_point.h"
#include "geom/io/strand_file.h"
#include "geom/limit_surface.h"
#include "geom/strand_counts.h"
#include "geom/strands.h"
#include "groom/follicles.h"
#include "groom/groom_params.h"

namespace pelage {

class TextureLibrary;
struct GroomCacheReport;
struct Job;

/// A skin in the pose of a frame: one limit surface, and one tree over the frame's tessellation, per motion
/// key.
struct PosedSkin {
  std::span<const LimitSurface> keys;       ///< empty for a groom without a skin
  std::span<const ClosestPointTree> trees;  ///< empty when no operator needs the skin's inside
  float scale = 1;  ///< uniform scale of the character, applied to strands about their roots
  /// Transforms of strands without a skin, one per motion key. Empty: the strands keep the positions of their
  /// file.
  std::span<const M44f> free_transforms;
  float length = 1;  ///< scale of the finished strands about their roots, excluding their widths
};

/// The strands of a leaf to grow, and their modifications for level of detail.
struct KeptStrands {
  std::span<const uint32_t> strands;  ///< indices in the leaf, ascending
  std::span<const float> width;       ///< one per strand: factor on its width
  std::span<const float>
      contrast;  ///< one per strand: factor on the deviation of its colour from the mean; or empty
};

/// A coat on a skin: follicles and the operators that shape their strands.
///
/// Operators that only read rest state run on the rest surface; the follicle frames carry the result to each
/// pose (root + frame * offset * scale). The first operator that reads live state, and all operators after
/// it, run on the posed strands of every motion key. With `cache:`, the result of the operators up to the
/// operator named by `freeze` is quantised (groom/frozen_leaf.h) and stored in files. Strands are then always
/// grown from the quantised data, whether this data was just computed or read. Every strand is a pure
/// function of the groom, its id and the pose (law 1). Strands of a file grow the same way: their points are
/// the state before the first operator, their ids the order of the file, their roots the nearest points of
/// the rest skin.
///
/// Immutable. Thread safety: const members may be called from any thread.
class Groom {
 public:
  /// Places follicles and prepares the operators (clump centres, guides). `name` is for messages; `rest` is
  /// null for a groom without a skin. Throws Error: kInput for missing maps, missing guide files and invalid
  /// combinations; kMemory before making anything for which the ledger has no room; kStopped when the job is
  /// stopped. Problems with a cache are warnings to the job's progress and do not stop growing.
  static std::shared_ptr<const Groom> create(const std::string& name, const GroomParams& params,
                                             std::shared_ptr<const LimitSurface> rest,
                                             TextureLibrary& textures, const Job& job);
  ~Groom();

  const FollicleTree& follicles() const;
  StrandRole role() const;
  bool needs_closest_point() const;
  /// Hash of everything that shapes the strands, including live operators and this build of the program:
  /// grooms with equal hashes grow equal strands in equal leaves.
  const ContentHash& content_hash() const;
  /// Store for data derived from the groom; null without a cache.
  const ContentStore* store() const;
  /// State of the cache; null without one (groom/cache_report.h).
  const GroomCacheReport* cache_report() const;
  /// Repairs made to the strands file.
  StrandRepairs repairs() const;

  /// All strands of a leaf in a pose, ids ascending. They have the attribute "color" (3 components) when an
  /// operator colours them: constant, per strand or per point, the smallest of these that can hold the
  /// colours. With `kept`, grows only some of the strands. This costs as much as growing every strand up to
  /// the last kept strand.
  Strands grow(size_t leaf, const PosedSkin& pose, const KeptStrands* kept = nullptr) const;

  /// Exact counts of grow() for the whole leaf or its first `count` strands. The number of motion keys is not
  /// included, because it depends on the pose.
  StrandCounts counts(size_t leaf, size_t count = SIZE_MAX) const;

  bool grows_on_skin() const;
  /// Root of a strand at a motion key. Without a skin, the result has no derivatives.
  SurfacePoint root(size_t follicle, const PosedSkin& pose, size_t key) const;
  /// Uniformly distributed over [0, 1), a function of the strand's id only. Strands of smaller value are kept
  /// longer when detail is reduced. Ascends within a leaf where has_priority_order().
  float priority(size_t follicle) const;
  bool has_priority_order() const;
  /// Upper bound of the distance from any point of a strand, radius included, to its root, for a character of
  /// scale 1.
  float reach() const;
  /// Approximate width of the widest strands, for a character of scale 1. Independent of how the coat is
  /// divided.
  float width() const;
  /// A box that contains every point +- radius that grow() can return. It is computed from the roots in the
  /// pose, the longest strand and the reach of each operator; no strands are grown. `count`: bound only the
  /// first `count` strands.
  Box3f conservative_bound(size_t leaf, const PosedSkin& pose, size_t count = SIZE_MAX) const;

 private:
  struct Impl;
  explicit Groom(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace pelage
