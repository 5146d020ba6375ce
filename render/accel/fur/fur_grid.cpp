// SPDX-License-Identifier: Apache-2.0
#include "render/accel/fur/fur_grid.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

constexpr float kStepsPerWidth = 192;

}  // namespace

FurGrid::FurGrid(float root_width, const V3f& anchor) : anchor_(anchor) {
  if (!(root_width > 0) || !std::isfinite(root_width)) root_width = 0x1p-12f;
  int exponent = 0;
  std::frexp(std::clamp(root_width, 0x1p-60f, 0x1p60f) / kStepsPerWidth, &exponent);
  step_ = std::ldexp(1.0f, exponent - 1);
  inverse_ = std::ldexp(1.0f, 1 - exponent);
}

float FurGrid::margin(float radius) const {
  // Inner points move by at most a step, and the square root of the radius by half of one of its own steps.
  const float root = kRootsPerUnit * std::sqrt(std::max(radius * inverse_, 0.0f));
  const float wider = (root + 0.25f) / (kRootsPerUnit * kRootsPerUnit);
  return 1.001f * step_ * (1 + wider);
}

}  // namespace pelage
