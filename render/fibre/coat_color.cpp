// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/coat_color.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

constexpr int kWalks = 4096;
/// Square roots of the absorptions at which the brightness is computed.
constexpr std::array<float, 12> kRoots = {0.02f, 0.04f, 0.08f, 0.14f, 0.22f, 0.33f,
                                          0.48f, 0.7f,  1.0f,  1.5f,  2.4f,  6.0f};

/// The root of the absorption where the decreasing brightness over kRoots equals `wanted`; the brightness at
/// 0 is taken as 1, or more if needed.
float root_of(const std::array<double, kRoots.size()>& brightness, double wanted) {
  double root = 0, above = 1;
  for (size_t i = 0; i < kRoots.size(); ++i) {
    if (brightness[i] <= wanted) {
      if (above <= wanted) return static_cast<float>(root);
      const double t = std::log(wanted / above) / std::log(brightness[i] / above);
      return static_cast<float>(root + t * (kRoots[i] - root));
    }
    root = kRoots[i];
    above = brightness[i];
  }
  return static_cast<float>(root);
}

}  // namespace

const std::array<float, CoatColor::kColors> CoatColor::kColor = {1,    0.9f,  0.75f, 0.6f,   0.45f, 0.3f,
                                                                 0.2f, 0.12f, 0.06f, 0.015f, 0.001f};
const std::array<float, CoatColor::kColors> CoatColor::kBrightness = {
    1, 0.9641f, 0.8253f, 0.6551f, 0.4860f, 0.3277f, 0.2264f, 0.1490f, 0.0889f, 0.0373f, 0.0153f};

CoatColor::CoatColor(const Scatter& scatter, const Workers& workers) {
  std::array<double, kRoots.size()> brightness;
  workers.for_each(kRoots.size(), 1, [&](const WorkRange& range) {
    for (size_t i = range.begin; i < range.end; ++i) {
      const float t = kRoots[i] * kRoots[i];
      brightness[i] =
          tangle_reflectance([&](const TangleHit& hit, const V3f& u) { return scatter(t, hit, u); }, kWalks);
    }
  });
  for (int i = 0; i < kColors; ++i) root_[i] = root_of(brightness, kBrightness[i]);
}

Rgb CoatColor::operator()(const Rgb& color) const {
  Rgb t;
  for (int c = 0; c < 3; ++c) {
    const float wanted = std::clamp(color[c], kColor.back(), 1.0f);
    int i = 0;
    while (i + 2 < kColors && wanted < kColor[i + 1]) ++i;
    const float share = std::log(wanted / kColor[i]) / std::log(kColor[i + 1] / kColor[i]);
    const float root = root_[i] + share * (root_[i + 1] - root_[i]);
    t[c] = root * root;
  }
  return t;
}

}  // namespace pelage
