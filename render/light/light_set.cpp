// SPDX-License-Identifier: Apache-2.0
#include "render/light/light_set.h"

#include <algorithm>

#include "render/sampling/warp.h"

namespace pelage {

namespace {

constexpr double kUniformShare = 0.1;

}  // namespace

LightSet::LightSet(std::vector<std::unique_ptr<Light>> lights) : lights_(std::move(lights)) {}

void LightSet::importances(const V3f& from, std::span<float> out) const {
  for (size_t i = 0; i < lights_.size(); ++i) out[i] = lights_[i]->importance(from);
}

void LightSet::probabilities(const V3f& from, std::span<float> out) const {
  importances(from, out);
  normalise(out);
}

void LightSet::normalise(std::span<float> out) {
  double total = 0;
  size_t useful = 0;
  for (const float importance : out) {
    total += importance;
    useful += importance > 0.0f;
  }
  if (!(total > 0)) return;
  const double uniform = kUniformShare / static_cast<double>(useful);
  for (float& p : out) {
    if (p > 0.0f) p = static_cast<float>((1 - kUniformShare) * p / total + uniform);
  }
}

LightSet::Choice LightSet::choose(std::span<const float> probabilities, float u) {
  Choice choice;
  float rest = u;
  for (size_t i = 0; i < probabilities.size(); ++i) {
    const float p = probabilities[i];
    if (!(p > 0.0f)) continue;
    choice = {i, p, std::min(rest / p, kBelowOne)};
    if (rest < p) break;
    rest -= p;  // the last light gets the rounding remainder
  }
  return choice;
}

}  // namespace pelage
