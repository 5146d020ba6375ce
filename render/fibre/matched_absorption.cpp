// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/matched_absorption.h"

#include <algorithm>
#include <cmath>

#include "render/fibre/absorption.h"
#include "render/fibre/attenuation.h"
#include "render/fibre/deon.h"

namespace pelage {
namespace {

constexpr float kDarkest = 1e-3f;
constexpr float kMostRoot = 7;  // beyond, a fibre reflects only

float chiang_albedo(float sigma) {
  constexpr int kOffsets = 32;
  float sum = 0;
  for (int i = 0; i < kOffsets; ++i) {
    const FibreCrossing c(1.55f, 0, 0, 1, (static_cast<float>(i) + 0.5f) / kOffsets);
    const auto a = attenuations(c.reflectance, transmittance(Rgb(sigma), c.leg()));
    sum += a[0].x + a[1].x + a[2].x + a[3].x;
  }
  return sum / kOffsets;
}

}  // namespace

MatchedAbsorption::MatchedAbsorption(const std::function<float(float)>& albedo) {
  const ColorToAbsorption by_color(kColorRoughness);
  root_[0] = 0;
  for (int i = 1; i <= kCells; ++i) {
    const float color = std::pow(kDarkest, static_cast<float>(i) / kCells);
    const float target = chiang_albedo(by_color(Rgb(color)).x);
    float low = root_[i - 1], high = kMostRoot;
    for (int step = 0; step < 20; ++step) {
      const float middle = 0.5f * (low + high);
      (albedo(middle * middle) > target ? low : high) = middle;
    }
    root_[i] = 0.5f * (low + high);
  }
}

Rgb MatchedAbsorption::operator()(const Rgb& color) const {
  Rgb sigma;
  for (int c = 0; c < 3; ++c) {
    const float x = std::log(std::clamp(color[c], kDarkest, 1.0f)) / std::log(kDarkest) * kCells;
    const int i = std::clamp(static_cast<int>(x), 0, kCells - 1);
    const float root = root_[i] + (x - static_cast<float>(i)) * (root_[i + 1] - root_[i]);
    sigma[c] = root * root;
  }
  return sigma;
}

}  // namespace pelage
