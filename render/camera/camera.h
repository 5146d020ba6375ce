// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/keyed.h"
#include "base/schema.h"
#include "base/value_readers.h"
#include "base/vector.h"
#include "geom/view.h"
#include "lod/lod_view.h"
#include "render/camera/shutter_curve.h"

namespace pelage {

struct LensParams {
  float f_stop = 8;
  float focal_length = 5;      ///< scene units
  float focus_distance = 100;  ///< scene units, along the view axis
  static const Schema<LensParams>& schema();
};

enum class CameraProjection { kPerspective, kOrthographic };
template <>
struct EnumNames<CameraProjection> {
  static constexpr const char* names[] = {"perspective", "orthographic"};
};

struct CameraParams {
  /// What the picture shall show whole: a skin, a character or `all`. Position and target then give only the
  /// direction of the view, and world/camera_frame.h places the camera. Empty: they are used as they are.
  NameReference frame;
  Keyed<V3f> position{V3f(0, 0, 10)};
  Keyed<V3f> look_at{V3f(0)};
  Keyed<V3f> up{V3f(0, 1, 0)};
  Keyed<float> fov{40.0f};                     ///< vertical, degrees; unused if orthographic
  std::optional<Keyed<float>> orthographic;    ///< height of the picture in scene units; empty: perspective
  std::optional<CameraProjection> projection;  ///< empty: orthographic if the key `orthographic` is given
  std::optional<Keyed<float>> focal_length;    ///< mm; with `sensor`, replaces `fov`
  float sensor = 36;                           ///< width of what the picture shows in the image plane, mm
  V2f shift{0, 0};              ///< of the lens, in widths and heights of the picture: right and up
  Keyed<float> exposure{0.0f};  ///< stops; world/compose.cpp applies it to the lights
  std::optional<float> f_stop;  ///< with the focal length in mm, replaces `lens`
  std::optional<Keyed<float>> focus_distance;  ///< of f_stop, scene units; empty: the distance of look_at
  NameReference focus_on;  ///< skin or character in focus; world/camera_frame.h sets the distance
  V2f shutter{0, 0};       ///< opening and closing time, in frames relative to the frame
  ShutterCurve shutter_curve;
  int motion_keys = 2;
  std::optional<LensParams> lens;
  float meters_per_unit = 0.01f;  ///< no key of the block: load_scene() copies it from `units`

  bool is_orthographic() const;
  /// Returns the vertical field of view in degrees. `time`: in frames. `aspect`: width of the picture divided
  /// by its height.
  float fov_at(double time, float aspect) const;
  /// Returns the height of the picture in scene units. The camera must be orthographic.
  float height_at(double time, float aspect) const;
  /// Returns the lens, from `lens` or from `f_stop`. Empty: a pinhole camera, or an orthographic one.
  std::optional<LensParams> lens_at(double time, float aspect) const;
  static const Schema<CameraParams>& schema();
};

struct CameraRay {
  V3f origin{0};
  V3f direction{0};  ///< unit
  float time = 0;    ///< shutter time: 0 at shutter open, 1 at shutter close
};

/// A camera over the shutter of one frame. Right-handed, looks along -z of its own space. Between
/// `motion_keys` evenly spaced times of the shutter, the position, the axes and the tangent of half the field
/// of view are interpolated linearly, like geometry; the axes are then orthonormalised. The lines of sight of
/// an orthographic camera are parallel. They start in the plane of the camera; a lens has no effect. A shift
/// moves the picture within the image plane: the axes stay, and the view axis is no longer in its centre.
///
/// World points are relative to the origin of the constructor; the matrices of the header are not.
///
/// Raster space: pixels, x right, y down, (0, 0) at the upper left corner of the image.
class Camera {
 public:
  /// Throws Error (kInput) when, at any motion key, at the time of the frame or at the next frame, the camera
  /// is at its target or looks along its up vector.
  /// `origin`: RenderScene::origin.
  Camera(const CameraParams& params, double frame, int width, int height, const V3f& origin = V3f(0));

  /// Returns the ray through raster position (x, y) and lens position `lens` in [0, 1)^2 at shutter time
  /// `time` in [0, 1].
  CameraRay ray(float x, float y, const V2f& lens, float time) const;
  /// Returns the shutter time of a random number `u` in [0, 1): distributed as the shutter lets light
  /// through.
  float sampled_time(float u) const { return shutter_curve_.time(u); }
  /// Projects a world point at a shutter time. Returns the raster position as x and y, and the depth along
  /// the view axis as z. Empty if the point is behind the camera.
  std::optional<V3f> project(const V3f& world, float time) const { return project(pose_at(time), world); }
  /// Returns where in the picture a ray from ray() is, through any point of the lens: (0, 0) at the upper
  /// left corner, (1, 1) at the lower right corner.
  V2f picture_position(const V3f& origin, const V3f& direction, float time) const;
  /// Returns the length in the picture, in pixels, of a line through world points at a shutter time.
  /// `points`: (x, y, z, radius) of each point. Parts of the line with an end behind the camera do not count.
  float projected_length(std::span<const float> points, float time) const;
  /// Projects a world point at the time of the frame itself if `frames_ahead` is 0, or at the time of the
  /// next frame if it is 1.
  std::optional<V3f> project_at_frame(const V3f& world, int frames_ahead) const {
    return project(frames_ahead == 0 ? frame_ : next_frame_, world);
  }

  /// Whether any part of a box may be in the picture while the shutter is open, seen through any point of the
  /// lens. False only when the box is empty, is entirely behind the camera or is entirely beyond one border
  /// of the picture.
  bool may_see(const Box3f& box) const;

  /// Returns the view at the time of the frame itself, for tessellation.
  View view() const;
  /// Returns the input of level of detail: the camera at shutter open and close, and the lens.
  LodView lod_view() const;
  V3f position(float time) const { return pose_at(time).position; }
  V3f axis(float time) const { return pose_at(time).forward; }  ///< unit view direction
  bool has_lens() const { return lens_radius_ > 0; }
  float shutter_open() const { return shutter_.x; }                 ///< in frames relative to the frame
  float shutter_frames() const { return shutter_.y - shutter_.x; }  ///< duration of the shutter, in frames
  /// Shutter time (0 open, 1 close) of the frame itself; outside [0, 1] when the time of the frame is not
  /// within the shutter. 0 if the shutter has no duration.
  float frame_time() const;

  /// Values of the EXR attributes worldToCamera and worldToNDC at the time of the frame itself. Camera space
  /// is left-handed: +y is up, and the camera looks along +z. After division by w, NDC has (0, 0) in the
  /// upper left corner and (1, 1) in the lower right corner. The matrices apply to row vectors: p * M.
  M44f world_to_camera() const;
  M44f world_to_ndc() const;
  /// Value of the EXR attribute screenWindowWidth: width of what the picture shows at distance 1.
  float screen_window_width() const { return 2 * frame_.half_height * aspect(); }
  /// Value of the EXR attribute screenWindowCenter: position of the centre of the picture at distance 1,
  /// relative to the view axis, right and up.
  V2f screen_window_center() const {
    return V2f(screen_window_width() * shift_.x, 2 * frame_.half_height * shift_.y);
  }

 private:
  struct Pose {
    V3f position{0}, right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
    /// Half the height of the picture at distance 1, or at any distance if the camera is orthographic.
    float half_height = 1;
  };
  float aspect() const { return static_cast<float>(width_) / static_cast<float>(height_); }
  static Pose make_pose(const CameraParams& params, double frame, float aspect, const V3f& origin);
  /// Raster position of the view axis.
  float axis_x() const { return (0.5f - shift_.x) * static_cast<float>(width_); }
  float axis_y() const { return (0.5f + shift_.y) * static_cast<float>(height_); }
  static Pose blend(const Pose& a, const Pose& b, float t);
  Pose pose_at(float time) const;
  std::optional<V3f> project(const Pose& pose, const V3f& world) const;
  /// Returns the factor from scene units at this depth to pixels.
  float pixels_at(const Pose& pose, float depth) const {
    return static_cast<float>(height_) / (2 * pose.half_height * (parallel_ ? 1 : depth));
  }

  std::vector<Pose> keys_;  // over the shutter; one key for a static camera
  Pose frame_, next_frame_;
  V3f origin_;
  V2f shutter_, shift_;
  ShutterCurve shutter_curve_;
  int width_, height_;
  bool parallel_ = false;  // orthographic
  float lens_radius_ = 0, focus_distance_ = 0;
};

}  // namespace pelage
