// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "base/hash.h"
#include "geom/limit_surface.h"
#include "geom/pose_sequence.h"
#include "geom/view.h"
#include "procedurals/skin/deferred_skin.h"
#include "procedurals/skin/pose_cache.h"

namespace pelage {

/// Control points of one skin of one character at several times, in world space.
struct PosedCages {
  std::vector<std::vector<V3f>> cages;  ///< one per time
  std::vector<M44f> transforms;         ///< object to world space, one per time; for strands without a skin
};

/// Motion of one skin of one character from the frame to the next one.
struct FrameMotion {
  std::array<M44f, 2> transforms;  ///< object to world space
  /// Cages in object space; empty if they are at rest at both times.
  std::optional<std::array<BlendedPose, 2>> poses;
};

/// One skin of one character in a frame: the input of a PosedCharacterSkin.
struct CharacterPose {
  std::shared_ptr<const SurfaceTopology> topology;
  /// Cages at evenly spaced times from shutter open to close; at one time if nothing moves or the shutter
  /// opens and closes at the same time.
  PosedCages shutter;
  /// Cages at the two ends of the frame interval, frame - 1/2 and frame + 1/2; empty if `shutter` has one
  /// time.
  PosedCages frame_ends;
  std::optional<FrameMotion> motion;  ///< for motion vectors; empty if nothing moves
  /// Scale of the character, by which strands are scaled about their roots. For a non-uniform scale, this is
  /// the cube root of the determinant. The directions of strands follow the posed cage.
  float scale = 1;
  float length = 1;  ///< factor on the length of strands, but not on their radii
  /// View for which the skin is tessellated for the operator push_out, which needs triangles. Empty if no
  /// groom on this skin has this operator.
  std::optional<View> push_out_view;
};

/// A skin of one character in a frame. Stores only the posed cages, which take a few kilobytes. Poses
/// (SkinPose) are made when strands grow or the skin is tessellated. Whole poses are shared through a
/// PoseCache.
class PosedCharacterSkin final : public DeferredSkin {
 public:
  PosedCharacterSkin(CharacterPose pose, std::shared_ptr<PoseCache> poses);

  int motion_keys() const override { return static_cast<int>(pose_.shutter.cages.size()); }
  const SurfaceTopology& topology() const { return *pose_.topology; }

  float scale() const { return pose_.scale; }
  float length() const { return pose_.length; }

  /// Returns a pose of the whole skin, for growing strands. kShutter: one key per motion key. kFrame: these
  /// keys, preceded and followed by one key at each end of the frame interval. Thus a bound over the frame
  /// contains everything that is visible while the shutter is open. Keeps the pose in the PoseCache.
  std::shared_ptr<const SkinPose> pose(BoundSpan span) const;
  /// Returns a pose of only some faces, without trees. It is not shared. Not for grooms with the operator
  /// push_out.
  SkinPose pose(BoundSpan span, std::span<const uint32_t> faces) const;
  /// Announces to the PoseCache that the leaves of a groom will grow on this skin. `together`: false if each
  /// pose contains the faces below a single leaf; true if it may contain the faces below any number of
  /// leaves.
  void reserve_for_leaves(const Groom& groom, bool together = false) const;

  /// Returns the box of all control points over the span, enlarged by 0.1 % of its diagonal.
  Box3f bound(BoundSpan span) const;
  std::vector<SkinPiece> divide(const View& view, size_t max_cost, const Job& job) const override;
  /// Returns the box of the control points on which the piece depends, enlarged by 0.1 % of its diagonal.
  Box3f bound(const SkinPiece& piece, BoundSpan span) const override;
  SkinMesh tessellate(const SkinPiece& piece, const View& view) const override;
  size_t temporary_bytes(const SkinPiece& piece) const override;
  std::optional<ContentHash> content() const override { return hash_; }
  uint32_t face_count() const override { return pose_.topology->face_count(); }
  std::optional<SurfaceStep> step(const RootAddress* place) const override;
  std::optional<V3f> normal(const RootAddress& place) const override;

  /// Hash of everything that affects strands grown on this skin, except for length(): topology, control
  /// points at all times, transforms, scale, and push_out_view. Equal poses have equal hashes.
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
  mutable std::mutex mutex_;  // guards made_; locked while a pose is made, so that no pose is made twice
  mutable std::weak_ptr<const SkinPose> made_[2];
};

}  // namespace pelage
