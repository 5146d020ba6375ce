// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "base/hash.h"
#include "geom/limit_surface.h"
#include "geom/view.h"
#include "procedurals/deferred_skin.h"
#include "procedurals/pose_cache.h"
#include "procedurals/skin_pose.h"

namespace pelage {

/// Control points of one skin of one character at several times, in world space.
struct PosedCages {
  std::vector<std::vector<V3f>> cages;  ///< one per time
  std::vector<M44f> transforms;         ///< of the character, one per time; used for strands without a skin
};

/// Input of a PosedCharacterSkin.
struct CharacterPose {
  std::shared_ptr<const SurfaceTopology> topology;
  /// At evenly spaced times over the shutter; a single time when nothing moves or the shutter is closed.
  PosedCages shutter;
  /// At the two ends of the frame's interval [frame - 1/2, frame + 1/2]; empty when `shutter` has one time.
  PosedCages frame_ends;
  /// Scale of the character, applied to strands about their roots. For a non-uniform scale, it is the cube
  /// root of the determinant (frames come from the posed cage).
  float scale = 1;
  float length = 1;  ///< factor on the length of its strands; their radii are unchanged
  /// The view for which the skin is tessellated when the operator push_out needs triangles; empty when no
  /// groom has this operator.
  std::optional<View> push_out_view;
};

/// A skin of one character in a frame. Stores only the posed cages, which take a few kilobytes. Limit
/// surfaces and trees are made when something grows, and the expensive ones are shared through a PoseCache.
class PosedCharacterSkin final : public DeferredSkin {
 public:
  PosedCharacterSkin(CharacterPose pose, std::shared_ptr<PoseCache> poses);

  int motion_keys() const override { return static_cast<int>(pose_.shutter.cages.size()); }
  const SurfaceTopology& topology() const { return *pose_.topology; }

  float scale() const { return pose_.scale; }
  float length() const { return pose_.length; }

  /// A whole pose for growing strands. kShutter: one key per motion key. kFrame: the same keys, and one more
  /// at each end of the frame, in order of time, so that a bound over the frame contains everything visible
  /// during the shutter.
  std::shared_ptr<const SkinPose> pose(BoundSpan span) const;
  /// A pose for strands on `faces` that need no push_out. It has no trees and is not shared.
  SkinPose pose(BoundSpan span, std::span<const uint32_t> faces) const;
  /// Announces that the leaves of a groom will grow on this skin. Each leaf grows in a pose of only its
  /// faces; with `together`, any number of leaves share a pose.
  void reserve_for_leaves(const Groom& groom, bool together = false) const;

  /// The hull of the control points, slightly enlarged.
  Box3f bound(BoundSpan span) const;
  std::vector<SkinPiece> divide(const View& view, size_t max_cost, const Job& job) const override;
  /// The hull of the control points that shape the piece, slightly enlarged.
  Box3f bound(const SkinPiece& piece, BoundSpan span) const override;
  SkinMesh tessellate(const SkinPiece& piece, const View& view) const override;
  size_t temporary_bytes(const SkinPiece& piece) const override;

  /// Hash of everything that affects strands grown here, except `length`: topology, control points of all
  /// times, transforms, scale. Equal poses have equal hashes.
  ContentHash hash() const { return hash_; }
  size_t bytes() const;

 private:
  template <class AddSurface>
  void add_keys(BoundSpan span, SkinPose& pose, const AddSurface& add_surface) const;
  std::shared_ptr<const SkinPose> make(BoundSpan span) const;
  std::shared_ptr<const SkinPose> temporary_pose() const;
  template <class Visit>
  void visit_cages(BoundSpan span, const Visit& visit) const;

  CharacterPose pose_;
  std::shared_ptr<PoseCache> poses_;
  ContentHash hash_;
  mutable std::mutex mutex_;  // guards made_; held while a pose is made, so that it is made once
  mutable std::weak_ptr<const SkinPose> made_[2];
};

}  // namespace pelage
