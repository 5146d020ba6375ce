// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/keyed.h"
#include "base/schema.h"
#include "base/vector.h"
#include "geom/view.h"

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
  V2f shutter{0, 0};        ///< frames around the frame
  int motion_keys = 2;
  std::optional<LensParams> lens;
  static const Schema<CameraParams>& schema();
};

struct CameraRay {
  V3f origin{0};
  V3f direction{0};  ///< unit
  float time = 0;    ///< in [0, 1] of the shutter
};

/// A camera over the shutter of one frame: position and axes interpolated between shutter open and close.
/// Right-handed, looks along -z of its own space.
class Camera {
 public:
  Camera(const CameraParams& params, double frame, int width, int height);

  /// Ray through raster position (x, y) (pixels, y down, (0, 0) the upper left corner of the image), lens
  /// position `lens` in [0, 1)^2 and shutter time `time` in [0, 1].
  CameraRay ray(float x, float y, const V2f& lens, float time) const;
  /// Raster position and depth along the axis of a world point at a time; nothing behind the camera.
  std::optional<V3f> project(const V3f& world, float time) const;
  /// At the frame itself (shutter offset 0 when the shutter contains it): for tessellation and LOD.
  View view() const;
  V3f axis(float time) const;  ///< unit view direction
  M44f world_to_camera() const;
  M44f world_to_ndc()
      const;  ///< x, y in 0..1 after division by w, y down... as the EXR attribute worldToNDC wants

 private:
  struct Pose {
    V3f position, right, up, forward;
    float tan_half = 1;
  };
  Pose pose_at(float time) const;
  Pose open_, close_, middle_;
  int width_, height_;
  float lens_radius_ = 0, focus_distance_ = 0;
};

}  // namespace pelage
