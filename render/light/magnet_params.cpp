// SPDX-License-Identifier: Apache-2.0
#include "render/light/magnet_params.h"

#include <fmt/format.h>

#include "render/light/aim.h"
#include "render/light/rectangle_light.h"
#include "render/light/sphere_light.h"

namespace pelage {
namespace {

const KeyOptions kShareHelp{.help =
                                "Fraction of the rays leaving a surface that the magnet attracts. All "
                                "magnets together attract at most "
                                "nine tenths of the rays",
                            .min = 0,
                            .max = 1};

}  // namespace

const Schema<RectangleMagnetParams>& RectangleMagnetParams::schema() {
  static const Schema<RectangleMagnetParams> table = [] {
    Schema<RectangleMagnetParams> s(
        "rectangle magnet",
        "A rectangle that attracts rays, such as a window of a room. It emits and "
        "blocks nothing, and changes the noise of a picture, not its mean.");
    s.set_example(R"(magnets:
  window: {type: rectangle, position: [0, 2, -4], look_at: [0, 2, 0], size: [1, 1.5]})");
    s.key("position", &RectangleMagnetParams::position,
          {.unit = "scene units", .help = "Centre of the rectangle"});
    s.key("look_at", &RectangleMagnetParams::look_at,
          {.unit = "scene units", .help = "Point in front of the rectangle; both sides attract"});
    s.key("up", &RectangleMagnetParams::up, {.help = "Up vector: direction of the height"});
    s.key("size", &RectangleMagnetParams::size,
          {.unit = "scene units", .help = "Width and height", .min = 0, .above_min = true});
    s.key("share", &RectangleMagnetParams::share, kShareHelp);
    return s;
  }();
  return table;
}

const Schema<SphereMagnetParams>& SphereMagnetParams::schema() {
  static const Schema<SphereMagnetParams> table = [] {
    Schema<SphereMagnetParams> s(
        "sphere magnet",
        "A sphere that attracts rays, such as a bright patch of a wall. It emits and "
        "blocks nothing, and changes the noise of a picture, not its mean.");
    s.set_example(R"(magnets:
  patch: {type: sphere, position: [3, 1, 0], radius: 0.5, share: 0.4})");
    s.key("position", &SphereMagnetParams::position, {.unit = "scene units", .help = "Centre"});
    s.key("radius", &SphereMagnetParams::radius,
          {.unit = "scene units", .help = "Radius", .min = 0, .above_min = true});
    s.key("share", &SphereMagnetParams::share, kShareHelp);
    return s;
  }();
  return table;
}

MagnetSet::Magnet make_magnet(const std::string& name, const MagnetParams& params, double frame,
                              const V3f& origin) {
  if (const auto* sphere = std::get_if<SphereMagnetParams>(&params)) {
    return {std::make_unique<SphereLight>(name, relative_to(sphere->position, origin).at(frame),
                                          sphere->radius, Rgb(1), false),
            sphere->share};
  }
  const auto& p = std::get<RectangleMagnetParams>(params);
  const V3f center = relative_to(p.position, origin).at(frame);
  const std::optional<Aim> aim = Aim::at(center, relative_to(p.look_at, origin).at(frame), p.up);
  if (!aim) {
    throw Error(ErrorKind::kInput,
                fmt::format("magnets.{}: position and look_at are the same point at frame {}", name, frame));
  }
  const Rectangle shape{center, aim->x, aim->y, p.size * 0.5f};
  return {std::make_unique<RectangleLight>(name, shape, Rgb(1), true, false), p.share};
}

}  // namespace pelage
