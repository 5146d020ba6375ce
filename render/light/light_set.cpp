// SPDX-License-Identifier: Apache-2.0
#include "render/light/light_set.h"

#include <algorithm>
#include <array>

#include "render/sampling/warp.h"

namespace pelage {

namespace {

constexpr double kUniformShare = 0.1;

/// Storage for one number per light: on the stack for the number of lights that scenes usually have.
class LightScratch {
 public:
  explicit LightScratch(size_t count) : many_(count > few_.size() ? count : 0), count_(count) {}
  std::span<float> span() { return {many_.empty() ? few_.data() : many_.data(), count_}; }

 private:
  std::array<float, 32> few_;
  std::vector<float> many_;
  size_t count_;
};

}  // namespace

LightSet::LightSet(std::vector<std::unique_ptr<Light>> lights) : lights_(std::move(lights)) {}

void LightSet::importances(const V3f& from, const V3f& tangent, std::span<float> out) const {
  for (size_t i = 0; i < lights_.size(); ++i) out[i] = lights_[i]->importance(from, tangent);
}

void LightSet::probabilities(const V3f& from, const V3f& tangent, std::span<float> out) const {
  importances(from, tangent, out);
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

LightSet::Choice LightSet::choose(const V3f& from, const V3f& tangent, float u) const {
  LightScratch scratch(size());
  probabilities(from, tangent, scratch.span());
  return choose(scratch.span(), u);
}

float LightSet::probability(const V3f& from, const V3f& tangent, size_t light) const {
  LightScratch scratch(size());
  probabilities(from, tangent, scratch.span());
  return scratch.span()[light];
}

}  // namespace pelage
