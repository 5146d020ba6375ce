// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/camera/camera_test.cpp.
#include "base/value_readers.h"
#include "render/camera/camera.h"

namespace pelage {

const Schema<LensParams>& LensParams::schema() {
  static const Schema<LensParams> table = [] {
    Schema<LensParams> s("lens",
                         "A thin lens: what is out of focus blurs. Without it the camera is a pinhole.");
    s.key("f_stop", &LensParams::f_stop,
          {.help = "Aperture number: focal length / diameter of the opening", .min = 0, .above_min = true});
    s.key("focal_length", &LensParams::focal_length,
          {.unit = "scene units",
           .help = "Sets, with f_stop, the size of the opening (not the field of view)",
           .min = 0,
           .above_min = true});
    s.key("focus_distance", &LensParams::focus_distance,
          {.unit = "scene units",
           .help = "Distance along the view axis that is sharp",
           .min = 0,
           .above_min = true});
    return s;
  }();
  return table;
}

const Schema<CameraParams>& CameraParams::schema() {
  static const Schema<CameraParams> table = [] {
    Schema<CameraParams> s("camera",
                           "Where the picture is taken from, and for how long the shutter is open.");
    s.key("position", &CameraParams::position, {.unit = "scene units", .help = "Where the camera stands"});
    s.key("look_at", &CameraParams::look_at,
          {.unit = "scene units", .help = "The point in the middle of the image"});
    s.key("up", &CameraParams::up, {.help = "Direction that is up in the image"});
    s.key("fov", &CameraParams::fov,
          {.unit = "degrees", .help = "Vertical field of view", .min = 0.01, .max = 170});
    s.key("shutter", &CameraParams::shutter,
          {.unit = "frames",
           .help = "When the shutter opens and closes, relative to the frame; equal: no motion blur"});
    s.key("motion_keys", &CameraParams::motion_keys,
          {.help = "Times at which moving things are posed while the shutter is open; linear between them",
           .min = 2,
           .max = 64});
    s.key("lens", &CameraParams::lens, {.help = "Depth of field"});
    return s;
  }();
  return table;
}

}  // namespace pelage
