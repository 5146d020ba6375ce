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
    any_visible_ = any_visible_ || lights_[i]->visible();
  }
  if (size() - far_.size() <= kMaxListed) return;
  tree_ = LightTree(lights_);
  const uint32_t first = far_.empty() ? 0 : 1;
  for (const uint32_t far : far_) groups_[far] = 0;
  group_count_ = first + tree_.group(kNearGroups, first, groups_);
}

void LightSet::choose(LightChoices& choices, std::span<const float> u, std::span<Choice> chosen) const {
  const auto is_in_tree = [this](const Choice& choice) {
    return !tree_.empty() && choice.probability > 0 && choice.light >= far_.size();
  };
  choices.ways.clear();
  for (size_t i = 0; i < u.size(); ++i) {
    chosen[i] = choose(choices.probabilities, u[i]);
    if (is_in_tree(chosen[i]))
      choices.ways.push_back({choices.cut[chosen[i].light - far_.size()], 1, chosen[i].remapped});
  }
  if (tree_.empty()) return;
  tree_.descend(choices.from, choices.ways);
  auto way = choices.ways.begin();
  for (Choice& choice : chosen.first(u.size())) {
    if (is_in_tree(choice)) {
      choice = {tree_.light(*way), choice.probability * way->probability, way->u};
      ++way;
    } else if (choice.probability > 0) {
      choice.light = far_[choice.light];
    }
  }
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
    if (choice.probability > 0) rest -= choice.probability;
    choice.light = i;
    choice.probability = p;
    if (rest < p) break;  // the last light gets the rounding remainder
  }
  if (choice.probability > 0) choice.remapped = std::min(rest / choice.probability, kBelowOne);
  return choice;
}

}  // namespace pelage
