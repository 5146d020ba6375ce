// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

/// Position, orientation and focal length of the level-of-detail camera at one time.
struct LodPose {
  V3f position{0};
  V3f right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  ///< orthonormal
  float focal_pixels = 1;  ///< focal length in pixels: image height / (2 tan(fov / 2))
};

/// The level-of-detail camera while the shutter is open, and its lens. World space. The level of detail of a
/// strand depends only on this camera and the strand's root (law 3), not on the order of rays or the size of
/// boxes.
struct LodView {
  LodPose open, close;           ///< when the shutter opens and closes; equal for a static camera
  float near_distance = 1e-12f;  ///< scene units; pixels_per_unit() treats nearer points as at this distance
  float lens_diameter = 0;       ///< scene units; 0 for a pinhole camera
  float focus_distance = 1;      ///< scene units along `forward`
};

/// Returns the size in pixels of one scene unit at a point when the shutter opens. The size depends on the
/// distance of the point, not on its depth along the view axis. Therefore it is also defined for points
/// behind the camera, where objects may cast shadows.
float pixels_per_unit(const LodView& view, const V3f& point);
/// Returns the size in pixels of one scene unit at this distance from the camera. Distances below
/// LodView::near_distance count as near_distance.
float pixels_per_unit(const LodView& view, float distance);

/// Returns the cosine of the angle between the unit normal of the skin and the direction to the camera when
/// the shutter opens: 1 if the skin faces the camera, -1 if it faces away. Returns 1 if the normal is 0
/// (unknown).
float facing(const LodView& view, const V3f& point, const V3f& normal);

/// Returns the diameter of the circle of confusion of a point, in scene units at the depth of the point
/// [Ryu07]. The circle is the cross-section, at this depth, of the double cone from the rim of the lens
/// through a point in focus. Multiply by pixels_per_unit() to get the diameter of the blur in pixels. Points
/// behind the camera are treated as points in the plane of the camera.
float confusion_diameter(const LodView& view, const V3f& point);

/// Returns the distance by which a point moves across the picture while the shutter is open, in scene units
/// at the depth of the point. This is the length of the motion relative to the camera, projected onto the
/// plane perpendicular to the line of sight [Ryu07]. Multiply by pixels_per_unit() to get the length of the
/// blur in pixels.
float motion_across(const LodView& view, const V3f& at_open, const V3f& at_close);

/// Returns the component of the motion of motion_across() that is perpendicular to a line through the point,
/// such as a strand. `line`: direction of the line when the shutter opens. A unit vector means a certain
/// direction, a shorter vector a less certain one, 0 an unknown one. If `line` is 0 or parallel to the line
/// of sight, returns all of motion_across().
float motion_across_line(const LodView& view, const V3f& at_open, const V3f& at_close, const V3f& line);

}  // namespace pelage
