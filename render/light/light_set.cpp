// SPDX-License-Identifier: Apache-2.0
#include "render/light/light_set.h"

#include <algorithm>

#include "render/sampling/warp.h"

namespace pelage {

namespace {

constexpr double kUniformShare = 0.1;
/// Max count of groups of lights at finite distances, if there are more than kMaxListed.
constexpr size_t kNearGroups = 4;

}  // namespace

LightSet::LightSet(std::vector<std::unique_ptr<Light>> lights)
    : lights_(std::move(lights)), groups_(lights_.size()), group_count_(lights_.size()) {
  for (uint32_t i = 0; i < size(); ++i) {
    groups_[i] = i;
    if (lights_[i]->is_infinitely_far()) far_.push_back(i);
  }
  if (size() - far_.size() <= kMaxListed) return;
  tree_ = LightTree(lights_);
  const uint32_t first = far_.empty() ? 0 : 1;
  for (const uint32_t far : far_) groups_[far] = 0;
  group_count_ = first + tree_.group(kNearGroups, first, groups_);
}

LightSet::Choice LightSet::choose(const LightChoices& choices, float u) const {
  Choice choice = choose(choices.probabilities, u);
  if (tree_.empty() || !(choice.probability > 0)) return choice;
  if (choice.light < far_.size()) {
    choice.light = far_[choice.light];
    return choice;
  }
  const LightTree::Choice in_node =
      tree_.choose(choices.cut[choice.light - far_.size()], choices.from, choice.remapped);
  return {in_node.light, choice.probability * in_node.probability, in_node.remapped};
}

float LightSet::probability(const LightChoices& choices, size_t light) const {
  if (tree_.empty()) return choices.probabilities[light];
  if (lights_[light]->is_infinitely_far()) {
    const auto at = std::lower_bound(far_.begin(), far_.end(), light);
    return choices.probabilities[static_cast<size_t>(at - far_.begin())];
  }
  const LightTree::Place place = tree_.find(light, choices.from, choices.cut);
  return choices.probabilities[far_.size() + place.index] * place.probability;
}

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
