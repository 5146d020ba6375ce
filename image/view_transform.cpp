// SPDX-License-Identifier: Apache-2.0
#include "image/view_transform.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

/// From 1000 times white on, the curve is above 1 and is cut off.
constexpr float kBright = 1000;

float srgb(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

}  // namespace

float view_transform(float linear) {
  if (!(linear > 0)) return 0;
  const float x = 0.72f * std::min(linear, kBright);
  const float curve = x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f);
  return srgb(std::clamp(curve, 0.0f, 1.0f));
}

uint8_t view_byte(float linear) { return static_cast<uint8_t>(255 * view_transform(linear) + 0.5f); }

}  // namespace pelage
