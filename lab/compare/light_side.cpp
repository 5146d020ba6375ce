// SPDX-License-Identifier: Apache-2.0
#include "lab/compare/light_side.h"

#include <cmath>

#include "render/sampling/warp.h"

namespace pelage {
namespace {

constexpr float kHalfWidth = 8 * kPi / 180;
constexpr float kWall = 1.8f;
constexpr float kFill = 0.04f;

void add_sky(Named<LightParams>& lights, float radiance, bool visible) {
  EnvironmentLightParams sky;
  sky.radiance = Rgb(radiance);
  sky.visible = visible;
  lights.items.push_back({"sky", {}, sky});
}

}  // namespace

Named<LightParams> lights_from(const LightSide& side, const CameraParams& camera, double frame) {
  const V3f target = camera.look_at.at(frame);
  const V3f back = camera.position.at(frame) - target;
  const float distance = back.length();
  const V3f toward_camera = back / distance;
  const V3f right = camera.up.at(frame).cross(toward_camera).normalized();
  const V3f up = toward_camera.cross(right);
  const float turn = side.turn * (kPi / 180), rise = side.rise * (kPi / 180);
  const V3f direction =
      std::cos(rise) * (std::cos(turn) * toward_camera - std::sin(turn) * right) + std::sin(rise) * up;
  SphereLightParams lamp;
  lamp.position = Keyed<V3f>(target + distance * direction);
  lamp.radius = distance * std::sin(kHalfWidth);
  // The irradiance on a wall facing the lamp is pi L sin^2; a white wall's radiance is that over pi.
  lamp.radiance = Rgb(kWall / (std::sin(kHalfWidth) * std::sin(kHalfWidth)));
  Named<LightParams> lights;
  lights.items.push_back({side.name, {}, lamp});
  add_sky(lights, kFill, false);
  return lights;
}

Named<LightParams> white_furnace() {
  Named<LightParams> lights;
  add_sky(lights, 1, true);
  return lights;
}

}  // namespace pelage
