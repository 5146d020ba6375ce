// SPDX-License-Identifier: Apache-2.0
#include "render/light/light_params.h"

namespace pelage {

namespace {

const KeyOptions kRadiance{.unit = "W/(sr m2), or any unit used throughout the scene",
                           .help = "Emitted radiance: a colour or one number",
                           .min = 0};
const KeyOptions kIntensity{.help = "Factor on the radiance", .min = 0};
const KeyOptions kVisible{.help = "Whether camera rays see the light; it always lights fur and skin"};

}  // namespace

const Schema<RectangleLightParams>& RectangleLightParams::schema() {
  static const Schema<RectangleLightParams> table = [] {
    Schema<RectangleLightParams> s("rectangle", "A rectangular light with one or two emitting sides.");
    s.set_example(R"(lights:
  key:
    type: rectangle
    position: [-4, 6, 5]
    look_at: [0, 0.5, 0]
    size: [4, 4]
    radiance: [1, 0.93, 0.84]
    intensity: 10)");
    s.key("position", &RectangleLightParams::position,
          {.unit = "scene units", .help = "Centre of the rectangle"});
    s.key("look_at", &RectangleLightParams::look_at,
          {.unit = "scene units", .help = "Point that the emitting side faces"});
    s.key("up", &RectangleLightParams::up,
          {.help = "Up vector: direction of the rectangle's height. It must not be parallel to the viewing "
                   "direction from `position` to `look_at`"});
    s.key("size", &RectangleLightParams::size,
          {.unit = "scene units", .help = "Width and height", .min = 0, .above_min = true});
    s.key("radiance", &RectangleLightParams::radiance, kRadiance);
    s.key("intensity", &RectangleLightParams::intensity, kIntensity);
    s.key("two_sided", &RectangleLightParams::two_sided, {.help = "Emit to both sides"});
    s.key("visible", &RectangleLightParams::visible, kVisible);
    return s;
  }();
  return table;
}

const Schema<SphereLightParams>& SphereLightParams::schema() {
  static const Schema<SphereLightParams> table = [] {
    Schema<SphereLightParams> s("sphere", "A spherical light that emits in all directions.");
    s.set_example(R"(lights:
  lamp: {type: sphere, position: [0, 8, 4], radius: 0.5, intensity: 200})");
    s.key("position", &SphereLightParams::position, {.unit = "scene units", .help = "Centre of the sphere"});
    s.key("radius", &SphereLightParams::radius,
          {.unit = "scene units",
           .help = "Radius; smaller spheres cast sharper shadows",
           .min = 0,
           .above_min = true});
    s.key("radiance", &SphereLightParams::radiance, kRadiance);
    s.key("intensity", &SphereLightParams::intensity, kIntensity);
    s.key("visible", &SphereLightParams::visible, kVisible);
    return s;
  }();
  return table;
}

const Schema<EnvironmentLightParams>& EnvironmentLightParams::schema() {
  static const Schema<EnvironmentLightParams> table = [] {
    Schema<EnvironmentLightParams> s("environment",
                                     "Light from infinitely far away: a lat-long image (HDRI), sampled at "
                                     "its full resolution, or constant radiance.");
    s.set_example(R"(lights:
  sky: {type: environment, file: studio.hdr, rotate: [0, 90, 0]})");
    s.key("file", &EnvironmentLightParams::file,
          {.help =
               "Lat-long image, +y up, with its centre column along -z. Without a file the light is constant",
           .default_text = "none"});
    s.key("radiance", &EnvironmentLightParams::radiance,
          {.help = "Factor on the image, or the constant radiance without a file", .min = 0});
    s.key("intensity", &EnvironmentLightParams::intensity, kIntensity);
    s.key("rotate", &EnvironmentLightParams::rotate,
          {.unit = "degrees", .help = "Rotation of the image about x, then y, then z"});
    s.key("visible", &EnvironmentLightParams::visible, kVisible);
    return s;
  }();
  return table;
}

}  // namespace pelage
