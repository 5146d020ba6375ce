// SPDX-License-Identifier: Apache-2.0
#include "render/light/light_params.h"

namespace pelage {

namespace {

constexpr std::string_view kRadianceUnit = "W/(sr m2), or any unit used throughout the scene";
constexpr std::string_view kRadiance =
    "Emitted radiance: a colour or one number. With `power`, its colour only";
constexpr std::string_view kColor = "Colour, a factor on the power";

const KeyOptions kPower{.unit = "W, with lengths in scene units",
                        .help =
                            "Radiant power in each colour channel; the radiance then follows from the "
                            "area, and `radiance` multiplies it",
                        .min = 0};
const KeyOptions kLampPower{.unit = "W, with lengths in scene units",
                            .help =
                                "Radiant power of the whole sphere in each colour channel, also with a "
                                "profile, which only distributes it",
                            .min = 0,
                            .default_text = "100, or as `profile` states"};
const KeyOptions kProfile{.help =
                              "Photometric file of a luminaire (IES, LM-63, type C): how brightly it "
                              "shines in each direction. Without `power`, also how brightly altogether: "
                              "its lumens / 177.83 lm/W",
                          .default_text = "none"};
const KeyOptions kSpread{.unit = "degrees",
                         .help =
                             "Whole angle beyond which a grid in front of the light, as on a softbox, lets "
                             "no light pass. With `power`, a smaller spread makes the middle brighter",
                         .min = 1,
                         .max = 180};
const KeyOptions kSmallRadius{.unit = "scene units",
                              .help = "Radius; it changes the sharpness of shadows, not the brightness",
                              .min = 0,
                              .above_min = true};
const KeyOptions kLookAt{.unit = "scene units", .help = "Point that the emitting side faces"};

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
    s.key("look_at", &RectangleLightParams::look_at, kLookAt);
    s.key("up", &RectangleLightParams::up,
          {.help = "Up vector: direction of the rectangle's height. It must not be parallel to the viewing "
                   "direction from `position` to `look_at`"});
    s.key("size", &RectangleLightParams::size,
          {.unit = "scene units", .help = "Width and height", .min = 0, .above_min = true});
    s.key("power", &RectangleLightParams::power, kPower);
    s.key("two_sided", &RectangleLightParams::two_sided, {.help = "Emit to both sides"});
    s.key("file", &RectangleLightParams::file,
          {.help = "Image that multiplies the radiance, upright as seen from the emitting side",
           .default_text = "none"});
    s.key("spread", &RectangleLightParams::spread, kSpread);
    s.key("barn_doors", &RectangleLightParams::barn_doors,
          {.help = "Flaps at the sides; they cut light off and do not make the rest brighter"});
    add_emission_keys(s, kRadiance, kRadianceUnit);
    return s;
  }();
  return table;
}

const Schema<DiskLightParams>& DiskLightParams::schema() {
  static const Schema<DiskLightParams> table = [] {
    Schema<DiskLightParams> s("disk", "A round light that emits to one side.");
    s.set_example(R"(lights:
  key: {type: disk, position: [-4, 6, 5], look_at: [0, 0.5, 0], radius: 2, power: 600})");
    s.key("position", &DiskLightParams::position, {.unit = "scene units", .help = "Centre of the disk"});
    s.key("look_at", &DiskLightParams::look_at, kLookAt);
    s.key("radius", &DiskLightParams::radius,
          {.unit = "scene units", .help = "Radius", .min = 0, .above_min = true});
    s.key("power", &DiskLightParams::power, kPower);
    s.key("spread", &DiskLightParams::spread, kSpread);
    add_emission_keys(s, kRadiance, kRadianceUnit);
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
    s.key("power", &SphereLightParams::power, kPower);
    add_emission_keys(s, kRadiance, kRadianceUnit);
    return s;
  }();
  return table;
}

const Schema<PointLightParams>& PointLightParams::schema() {
  static const Schema<PointLightParams> table = [] {
    Schema<PointLightParams> s(
        "point",
        "A small lamp that emits in all directions, equally or by a profile: a sphere whose brightness does "
        "not depend on its radius.");
    s.set_example(R"(lights:
  bulb: {type: point, position: [0, 3, 2], power: 300, temperature: 2700}
  downlight: {type: point, position: [0, 5, 0], profile: downlight.ies, power: 800})");
    s.key("position", &PointLightParams::position, {.unit = "scene units", .help = "Centre"});
    s.key(
        "look_at", &PointLightParams::look_at,
        {.unit = "scene units",
         .help = "Point in the direction of the profile's vertical angle 0. Has no effect without `profile`",
         .default_text = "straight down"});
    s.key(
        "up", &PointLightParams::up,
        {.help =
             "Direction of the profile's horizontal angle 180. Seen from behind the lamp, 90 is at the left. "
             "If the lamp points in this direction, -z takes its place. Has no effect without `profile`"});
    s.key("radius", &PointLightParams::radius, kSmallRadius);
    s.key("power", &PointLightParams::power, kLampPower);
    s.key("profile", &PointLightParams::profile, kProfile);
    add_emission_keys(s, kColor);
    return s;
  }();
  return table;
}

const Schema<SpotLightParams>& SpotLightParams::schema() {
  static const Schema<SpotLightParams> table = [] {
    Schema<SpotLightParams> s(
        "spot",
        "A small lamp that shines into a cone. The cone only cuts the light of the lamp: "
        "a narrower cone is not brighter.");
    s.set_example(R"(lights:
  spot: {type: spot, position: [-2, 5, 3], look_at: [0, 0.5, 0], power: 2000, cone: 25, softness: 0.3})");
    s.key("position", &SpotLightParams::position, {.unit = "scene units", .help = "Centre of the lamp"});
    s.key("look_at", &SpotLightParams::look_at,
          {.unit = "scene units", .help = "Point on the axis of the cone"});
    s.key("up", &SpotLightParams::up,
          {.help = "Up vector of the image in `file`, and of the profile as for a point"});
    s.key("radius", &SpotLightParams::radius, kSmallRadius);
    s.key("power", &SpotLightParams::power, kLampPower);
    s.key("cone", &SpotLightParams::cone,
          {.unit = "degrees", .help = "Whole angle of the cone", .min = 0.1, .max = 170});
    s.key(
        "softness", &SpotLightParams::softness,
        {.help = "Fraction of the cone, from its border on, over which the light fades", .min = 0, .max = 1});
    s.key("file", &SpotLightParams::file,
          {.help = "Image that the spot projects (a gobo); its square fits around the cone",
           .default_text = "none"});
    s.key("profile", &SpotLightParams::profile, kProfile);
    add_emission_keys(s, kColor);
    return s;
  }();
  return table;
}

const Schema<SunLightParams>& SunLightParams::schema() {
  static const Schema<SunLightParams> table = [] {
    Schema<SunLightParams> s("sun", "A disk at infinity, such as the sun: its light is nearly parallel.");
    s.set_example(R"(lights:
  sun: {type: sun, direction: [1, -2, -1], irradiance: 4, temperature: 5500}
  sky: {type: environment, radiance: [0.2, 0.3, 0.5]})");
    s.key("direction", &SunLightParams::direction, {.help = "Direction in which the light travels"});
    s.key("angle", &SunLightParams::angle,
          {.unit = "degrees",
           .help = "Diameter of the disk; a larger disk casts softer shadows. The sun has 0.53",
           .min = 0.001,
           .max = 180});
    s.key("irradiance", &SunLightParams::irradiance,
          {.unit = "W/m2",
           .help = "Irradiance of a surface that faces the sun, in each colour channel; the radiance then "
                   "follows from the angle, and `radiance` multiplies it",
           .min = 0});
    add_emission_keys(s, "Radiance of the disc: a colour or one number. With `irradiance`, its colour only",
                      kRadianceUnit);
    return s;
  }();
  return table;
}

const Schema<MeshLightParams>& MeshLightParams::schema() {
  static const Schema<MeshLightParams> table = [] {
    Schema<MeshLightParams> s(
        "mesh",
        "Light from the outer sides of a mesh, whose corners turn left as seen from there. "
        "The mesh covers itself, but blocks no other light; to show it, also add it as a "
        "skin.");
    s.set_example(R"(lights:
  tube: {type: mesh, file: tube.obj, transform: {translate: [0, 3, 0]}, power: 200})");
    s.key("file", &MeshLightParams::file,
          {.help = "OBJ, USD (.usda) or Alembic (.abc) file; faces are flat", .required = true});
    s.key("transform", &MeshLightParams::transform,
          {.help = "Transform from the coordinates of the file to scene units and axes",
           .default_text = "none"});
    s.key("power", &MeshLightParams::power, kPower);
    add_emission_keys(s, kRadiance, kRadianceUnit);
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
    s.key("rotate", &EnvironmentLightParams::rotate,
          {.unit = "degrees", .help = "Rotation of the image about x, then y, then z"});
    add_emission_keys(s, "Factor on the image, or the constant radiance without a file");
    return s;
  }();
  return table;
}

}  // namespace pelage
