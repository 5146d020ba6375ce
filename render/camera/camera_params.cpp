// SPDX-License-Identifier: Apache-2.0
#include "base/value_readers.h"
#include "render/camera/camera.h"

namespace pelage {

const Schema<LensParams>& LensParams::schema() {
  static const Schema<LensParams> table = [] {
    Schema<LensParams> s(
        "lens", "A thin lens, which blurs what is out of focus. Without a lens the camera is a pinhole.");
    s.set_example(R"(camera:
  position: [0, 12, 60]
  look_at: [0, 9, 0]
  lens: {f_stop: 4, focal_length: 5, focus_distance: 55})");
    s.key("f_stop", &LensParams::f_stop,
          {.help = "F-number: focal length divided by the diameter of the aperture",
           .min = 0,
           .above_min = true});
    s.key("focal_length", &LensParams::focal_length,
          {.unit = "scene units",
           .help = "Focal length. With f_stop it sets the diameter of the aperture; it does not change the "
                   "field of view",
           .min = 0,
           .above_min = true});
    s.key("focus_distance", &LensParams::focus_distance,
          {.unit = "scene units",
           .help = "Distance of the focal plane along the view axis",
           .min = 0,
           .above_min = true});
    return s;
  }();
  return table;
}

const Schema<CameraParams>& CameraParams::schema() {
  static const Schema<CameraParams> table = [] {
    Schema<CameraParams> s("camera", "Position, direction and shutter of the camera.");
    s.set_example(R"(camera:
  position: [0, 12, 60]
  look_at: [0, 9, 0]
  fov: 24
  shutter: [-0.25, 0.25]   # a 180-degree shutter
# or: camera: {frame: rat, position: [1, 0.4, 1], fov: 24}   # the whole rat, from this direction)");
    s.key(
        "frame", &CameraParams::frame,
        {.help = "Places the camera so that the picture shows this skin, this character or `all` characters "
                 "whole, fur included, with a margin of 5 %. `position` and `look_at` then give only the "
                 "direction of the view (default: three-quarter, from the front, the right and above); "
                 "`fov` stays, and `orthographic` gets the height that fits. With keys, the camera is placed "
                 "for each key. The pose is that at the first of the scene file's `frames`, whichever frames "
                 "are rendered"});
    s.key("position", &CameraParams::position, {.unit = "scene units", .help = "Position of the camera"});
    s.key("look_at", &CameraParams::look_at,
          {.unit = "scene units", .help = "Target of the camera, at the centre of the image"});
    s.key("up", &CameraParams::up, {.help = "Up vector"});
    s.key("fov", &CameraParams::fov,
          {.unit = "degrees", .help = "Vertical field of view", .min = 0.01, .max = 170});
    s.key("orthographic", &CameraParams::orthographic,
          {.unit = "scene units",
           .help = "Height of the picture for parallel lines of sight, which start in the plane of the "
                   "camera. Without this key, the camera has perspective, with `fov`",
           .min = 0,
           .above_min = true});
    s.key("shutter", &CameraParams::shutter,
          {.unit = "frames",
           .help = "Shutter open and close, relative to the frame; equal values give no motion blur"});
    s.key("motion_keys", &CameraParams::motion_keys,
          {.help = "Number of poses over the shutter interval; motion is linear between them",
           .min = 2,
           .max = 64});
    s.key("lens", &CameraParams::lens, {.help = "Depth of field. Without a lens, the camera is a pinhole"});
    return s;
  }();
  return table;
}

}  // namespace pelage
