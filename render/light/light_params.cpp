// SPDX-License-Identifier: Apache-2.0
#include "render/light/light_params.h"

namespace pelage {

namespace {

const KeyOptions kRadiance{.unit = "W/(sr m2), or any unit that the whole scene shares",
                           .help = "Radiance that the light emits, a colour or one number",
                           .min = 0};
const KeyOptions kIntensity{.help = "Factor on the radiance", .min = 0};
const KeyOptions kVisible{.help = "Whether the camera sees the light itself; fur and skin always do"};

}  // namespace

const Schema<RectangleLightParams>& RectangleLightParams::schema() {
  static const Schema<RectangleLightParams> table = [] {
    Schema<RectangleLightParams> s("rectangle", "A rectangle that shines to one side, or to both.");
    s.key("position", &RectangleLightParams::position,
          {.unit = "scene units", .help = "Centre of the rectangle"});
    s.key("look_at", &RectangleLightParams::look_at,
          {.unit = "scene units", .help = "The side that shines faces this point"});
    s.key("up", &RectangleLightParams::up,
          {.help = "Direction that the height leans to; any that is not along the line of sight"});
    s.key("size", &RectangleLightParams::size,
          {.unit = "scene units", .help = "Width and height", .min = 0, .above_min = true});
    s.key("radiance", &RectangleLightParams::radiance, kRadiance);
    s.key("intensity", &RectangleLightParams::intensity, kIntensity);
    s.key("two_sided", &RectangleLightParams::two_sided, {.help = "Shine to both sides"});
    s.key("visible", &RectangleLightParams::visible, kVisible);
    return s;
  }();
  return table;
}

const Schema<SphereLightParams>& SphereLightParams::schema() {
  static const Schema<SphereLightParams> table = [] {
    Schema<SphereLightParams> s("sphere", "A sphere that shines to all sides.");
    s.key("position", &SphereLightParams::position, {.unit = "scene units", .help = "Centre of the sphere"});
    s.key("radius", &SphereLightParams::radius,
          {.unit = "scene units",
           .help = "Radius; small ones cast sharp shadows",
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
    Schema<EnvironmentLightParams> s(
        "environment",
        "Light from infinitely far away: a lat-long image (HDRI) sampled at its full "
        "resolution, or the same radiance from everywhere.");
    s.key("file", &EnvironmentLightParams::file,
          {.help = "Lat-long image, +y up, its centre column along -z; without one the light is constant",
           .default_text = "none"});
    s.key("radiance", &EnvironmentLightParams::radiance,
          {.help = "Factor on the image, or the radiance itself when there is none", .min = 0});
    s.key("intensity", &EnvironmentLightParams::intensity, kIntensity);
    s.key("rotate", &EnvironmentLightParams::rotate,
          {.unit = "degrees", .help = "Turns the image about x, then y, then z"});
    s.key("visible", &EnvironmentLightParams::visible, kVisible);
    return s;
  }();
  return table;
}

}  // namespace pelage
