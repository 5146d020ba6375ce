// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "base/keyed.h"
#include "base/schema.h"
#include "base/vector.h"
#include "geom/view.h"
#include "lod/lod_view.h"

namespace pelage {

struct LensParams {
  float f_stop = 8;
  float focal_length = 5;      ///< scene units
  float focus_distance = 100;  ///< scene units, along the view axis
  static const Schema<LensParams>& schema();
};

struct CameraParams {
  Keyed<V3f> position{V3f(0, 0, 10)};
  Keyed<V3f> look_at{V3f(0)};
  Keyed<V3f> up{V3f(0, 1, 0)};
  Keyed<float> fov{40.0f};  ///< vertical, degrees
  V2f shutter{0, 0};        ///< opening and closing time, in frames relative to the frame's time
  int motion_keys = 2;
  std::optional<LensParams> lens;
  static const Schema<CameraParams>& schema();
};

struct CameraRay {
  V3f origin{0};
  V3f direction{0};  ///< unit
  float time = 0;    ///< 0 when the shutter opens, 1 when it closes
};

/// A camera while the shutter of one frame is open. Its own space is right-handed, and it looks along -z.
/// Position, axes and field of view are known at `motion_keys` evenly spaced times of the shutter, and
/// interpolated linearly between them, like geometry.
///
/// Raster space: pixels, x right, y down, (0, 0) at the upper left corner of the image.
class Camera {
 public:
  /// Throws Error (kInput) when the camera is at its target or looks along its up vector.
  Camera(const CameraParams& params, double frame, int width, int height);

  /// Returns the ray through raster position (x, y) at shutter time `time` in [0, 1]. `lens`: two random
  /// numbers in [0, 1), which determine the point of the lens.
  CameraRay ray(float x, float y, const V2f& lens, float time) const;
  /// Projects a world point with the camera at a shutter time in [0, 1]. Returns the raster position in x and
  /// y, and the depth along the view axis in z. Empty if the point is behind the camera.
  std::optional<V3f> project(const V3f& world, float time) const { return project(pose_at(time), world); }
  /// As project(), with the camera at the time of the frame (`frames_ahead` = 0) or of the next frame (1).
  std::optional<V3f> project_at_frame(const V3f& world, int frames_ahead) const {
    return project(frames_ahead == 0 ? frame_ : next_frame_, world);
  }

  /// Returns whether any part of a box may be in the picture while the shutter is open, seen through any
  /// point of the lens. Returns false only if the whole box is behind the camera or beyond one border of the
  /// picture.
  bool may_see(const Box3f& box) const;

  /// Returns the view at the time of the frame itself, for tessellation.
  View view() const;
  /// Returns the camera at the start and the end of the shutter, and its lens, as input of level of detail.
  LodView lod_view() const;
  V3f position(float time) const { return pose_at(time).position; }
  V3f axis(float time) const { return pose_at(time).forward; }  ///< unit view direction
  bool has_lens() const { return lens_radius_ > 0; }
  float shutter_frames() const { return shutter_.y - shutter_.x; }  ///< frames that the shutter is open
  /// Returns the time of the frame itself as a shutter time: 0 when the shutter opens, 1 when it closes.
  /// Outside [0, 1] if the shutter is not open at the time of the frame. 0 for a closed shutter.
  float frame_time() const;

  // Values of the EXR attributes worldToCamera and worldToNDC, for row vectors: p * M. EXR's camera space is
  // left-handed, with +y up and looking along +z. In NDC, after division by w, (0, 0) is the upper left
  // corner of the picture, (1, 1) the lower right corner.
  M44f world_to_camera() const;
  M44f world_to_ndc() const;

 private:
  struct Pose {
    V3f position{0}, right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
    float tan_half = 1;  ///< tangent of half the vertical field of view
  };
  static Pose make_pose(const CameraParams& params, double frame);
  static Pose blend(const Pose& a, const Pose& b, float t);
  Pose pose_at(float time) const;
  std::optional<V3f> project(const Pose& pose, const V3f& world) const;

  std::vector<Pose> keys_;  // over the shutter; one key for a static camera
  Pose frame_, next_frame_;
  V2f shutter_;
  int width_, height_;
  float lens_radius_ = 0, focus_distance_ = 0;
};

}  // namespace pelage
