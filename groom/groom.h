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
  std::span<const LimitSurface> keys;       ///< empty for a groom on no skin
  std::span<const ClosestPointTree> trees;  ///< empty when no operator needs the skin's inside
  float scale = 1;  ///< uniform scale of the character, applied to strands about their roots
  /// Of strands that grow on no skin, one per motion key; empty: they stay where their file puts them.
  std::span<const M44f> free_transforms;
  float length = 1;  ///< scale of the finished strands about their roots; their widths stay
};

/// Which strands of a leaf are wanted, and how they differ from those that the operators make (level of
/// detail).
struct KeptStrands {
  std::span<const uint32_t> strands;  ///< by number in the leaf, ascending
  std::span<const float> width;       ///< one per strand: factor on its width
  std::span<const float>
      contrast;  ///< one per strand: factor on what tells its colour from the mean; or none
};

/// A coat on a skin: follicles and the operators that shape their strands.
///
/// Operators that read rest state only run on the rest surface; the result is carried to each pose by the
/// follicle frames (root + frame * offset * scale). From the first operator that reads live state on,
/// operators run on the posed strands of every motion key. With `cache:` what the operators up to the one
/// named by `freeze` do is kept in files, quantised (groom/frozen_leaf.h); strands are then always grown from
/// the quantised bytes, whether they were just made or read. Every strand is a pure function of the groom,
/// its id and the pose (law 1). Strands of a file grow the same way: their points are the state before the
/// first operator, their ids the order of the file, their roots the nearest points of the rest skin.
/// Immutable. Thread safety: const members may be called from any thread.
class Groom {
 public:
  /// Places follicles and prepares the operators (clump centres, guides). `name` is for messages; `rest` is
  /// null for a groom on no skin. Throws Error (kInput) for missing maps, guide files and combinations that
  /// make no sense, Error (kMemory) before anything is made that the ledger has no room for, Error
  /// (kStopped). What is wrong with a cache is a warning to the job's progress; growing goes on.
  static std::shared_ptr<const Groom> create(const std::string& name, const GroomParams& params,
                                             std::shared_ptr<const LimitSurface> rest,
                                             TextureLibrary& textures, const Job& job);
  ~Groom();

  const FollicleTree& follicles() const;
  StrandRole role() const;
  bool needs_closest_point() const;
  /// Of everything that shapes the strands, live operators and this build of the program included: grooms of
  /// equal hashes grow equal strands in equal leaves.
  const ContentHash& content_hash() const;
  /// Where what is made of the groom is kept; null without a cache.
  const ContentStore* store() const;
  /// What became of the cache; null without one (groom/cache_report.h).
  const GroomCacheReport* cache_report() const;
  /// What was mended in the strands file.
  StrandRepairs repairs() const;

  /// All strands of a leaf in a pose, ids ascending, with the attribute "color" (3 components) when an
  /// operator colours them: constant, per strand or per point, whichever is the least that holds the colours.
  /// Only some of them when `kept` is given; growing then costs as if all up to the last of them were.
  Strands grow(size_t leaf, const PosedSkin& pose, const KeptStrands* kept = nullptr) const;

  /// Exactly what grow() of the whole leaf, or of its first `count` strands, gives, but for the motion keys,
  /// which are the pose's.
  StrandCounts counts(size_t leaf, size_t count = SIZE_MAX) const;

  bool grows_on_skin() const;
  /// Where a strand stands at a motion key; on no skin, without derivatives.
  SurfacePoint root(size_t follicle, const PosedSkin& pose, size_t key) const;
  /// Evenly spread over [0, 1), from the strand's id alone: who comes first stays longest when detail is
  /// reduced. Ascends within a leaf where has_priority_order().
  float priority(size_t follicle) const;
  bool has_priority_order() const;
  /// Farthest that any point of a strand, with its radius, may be from its root, for a character of scale 1.
  float reach() const;
  /// Of the widest strands, about, for a character of scale 1: the same however the coat is divided.
  float width() const;
  /// A box that holds every point +- radius that grow() can give: roots in the pose, longest strand, each
  /// operator's reach. No strand is grown. Of the first `count` strands, where that is given.
  Box3f conservative_bound(size_t leaf, const PosedSkin& pose, size_t count = SIZE_MAX) const;

 private:
  struct Impl;
  explicit Groom(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace pelage
