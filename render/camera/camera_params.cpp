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

namespace {

void add_photographic_keys(Schema<CameraParams>& s) {
  s.key("projection", &CameraParams::projection,
        {.help = "`orthographic` without a height in `orthographic` shows the height that `fov` or "
                 "`focal_length` shows at `look_at`",
         .default_text = "perspective, or orthographic if that key is given"});
  s.key("focal_length", &CameraParams::focal_length,
        {.unit = "mm",
         .help = "Focal length, instead of `fov`: the picture is `sensor` wide at this distance",
         .min = 0.1,
         .max = 1e5});
  s.key("sensor", &CameraParams::sensor,
        {.unit = "mm",
         .help = "Width of the sensor, for `focal_length` and `f_stop`. Its height follows from the "
                 "picture's aspect ratio",
         .min = 0.1,
         .max = 1e3});
  s.key("shift", &CameraParams::shift,
        {.unit = "widths and heights of the picture",
         .help = "Lens shift: moves the picture to the right and up in the image plane. Lines that are "
                 "parallel to this plane stay parallel"});
  s.key("exposure", &CameraParams::exposure,
        {.unit = "stops",
         .help = "Each stop doubles the light of all lights; `image.background` does not change",
         .min = -64,
         .max = 64});
  s.key("f_stop", &CameraParams::f_stop,
        {.help = "F-number: depth of field with the aperture of a lens of `focal_length` (or of the focal "
                 "length that `fov` and `sensor` give), in the length of `units`; instead of `lens`",
         .min = 0.01,
         .default_text = "a pinhole"});
  s.key("focus_distance", &CameraParams::focus_distance,
        {.unit = "scene units",
         .help = "Distance of the focal plane of `f_stop` along the view axis",
         .min = 0,
         .above_min = true,
         .default_text = "the distance of look_at"});
  s.key("focus_on", &CameraParams::focus_on,
        {.help = "Skin or character, such as the eyes, whose middle is in focus at each frame, with `f_stop` "
                 "or `lens`. Of the animals of a crowd, the one nearest to the camera"});
}

}  // namespace

const Schema<CameraParams>& CameraParams::schema() {
  static const Schema<CameraParams> table = [] {
    Schema<CameraParams> s("camera", "Position, direction and shutter of the camera.");
    s.set_example(R"(camera:
  position: [0, 12, 60]
  look_at: [0, 9, 0]
  fov: 24
  shutter: [-0.25, 0.25]   # a 180-degree shutter
# or: camera: {frame: rat, position: [1, 0.4, 1], fov: 24}   # the whole rat, from this direction
# or: camera: {frame: rat, focal_length: 85, f_stop: 2.8, focus_on: eyes, exposure: 0.5})");
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
                   "camera. Without this key, the camera has perspective, with `fov`, unless `projection` "
                   "says otherwise",
           .min = 0,
           .above_min = true});
    add_photographic_keys(s);
    s.key("shutter", &CameraParams::shutter,
          {.unit = "frames",
           .help = "Shutter open and close, relative to the frame; equal values give no motion blur"});
    s.key(
        "shutter_curve", &CameraParams::shutter_curve,
        {.help = "Light that passes the shutter from opening (0) to closing (1): `box`, `triangle`, "
                 "`trapezoid` (opens during the first quarter, closes during the last), or points [time, "
                 "weight] with straight lines between them. The brightness of the picture does not change"});
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
