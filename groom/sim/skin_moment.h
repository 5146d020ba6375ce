// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "groom/sim/rod_pack.h"

namespace pelage {

class ClosestPointTree;
struct SkinMesh;

/// A skin on which the guides do not grow, before and after a movement. Both meshes have the same triangles.
/// In scene units.
struct OtherSkin {
  const SkinMesh* mesh_before = nullptr;
  const SkinMesh* mesh = nullptr;
  const ClosestPointTree* before = nullptr;
  const ClosestPointTree* now = nullptr;
  Box3f box_before, box;
  double motion = 0;  ///< max distance that a vertex moves
};

/// The skins at one time.
struct SkinMoment {
  std::vector<RodRoot> roots;  ///< of the guides, in metres; z axis: the normal of the skin
  /// The skin in scene units. Null: guides may pass it.
  const ClosestPointTree* skin = nullptr;
  double meters_per_unit = 1;
  std::vector<OtherSkin> others = {};  ///< that guides must not pass
};

/// The nearest place of a skin, in metres.
struct SkinPlace {
  V3d position{0};
  V3d outward{0};     ///< unit
  double height = 0;  ///< of the point above it; negative inside
};
/// Looks for the nearest place within the distance `limit` (metres).
std::optional<SkinPlace> nearest_place(const ClosestPointTree& skin, double meters_per_unit, const V3d& point,
                                       double limit);

/// Movement of a node of a guide, in metres.
struct NodeMove {
  V3d before{0};
  V3d after{0};      ///< where it is expected
  double reach = 0;  ///< from `after`: where it may be instead
  double clearance = 0;
};
/// Returns the plane of another skin that a node meets first; none if there is no such skin near. The plane
/// lies on the side of the skin where the node was before, at the place of the skin that was nearest then. So
/// a skin that is thinner than its movement takes the node along. `root`: space of the plane.
CarriedPlane plane_of_others(const SkinMoment& at, const NodeMove& node, const RodRoot& root);
/// Returns how far a point inside other skins must move to be outside them.
V3d way_out_of_others(const SkinMoment& at, const V3d& point, double clearance, double limit);

}  // namespace pelage
