// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "render/light/light.h"
#include "render/light/light_tree.h"
#include "render/sampling/warp.h"

namespace pelage {

/// The probabilities of selecting each light at one point: memory of LightSet::prepare(), reused.
struct LightChoices {
  V3f from{0};
  std::vector<float> probabilities;  ///< of each light; with a tree, of each far light and each node of `cut`
  std::vector<uint32_t> cut;         ///< nodes of the tree
  std::vector<float> importances;    ///< of `cut`
  std::vector<LightTree::Way> ways;  ///< memory of LightSet::choose()
};

/// The lights of a scene, and random selection among them. For MIS, callers must multiply the pdf of a light
/// by the probability of selecting the light, also when a scattered ray hits the light by chance. Thread
/// safety: const members may be called from any thread.
class LightSet {
 public:
  explicit LightSet(std::vector<std::unique_ptr<Light>> lights);

  size_t size() const { return lights_.size(); }
  const Light& light(size_t i) const { return *lights_[i]; }
  /// Returns whether camera rays see any light.
  bool any_visible() const { return any_visible_; }
  /// For Light::link() after the parts of the frame are known; nothing else may change.
  Light& light(size_t i) { return *lights_[i]; }

  /// A selected light.
  struct Choice {
    size_t light = 0;
    float probability = 0;  ///< 0 when no light can contribute
    float remapped = 0;     ///< `u` rescaled to [0, 1) within the choice
  };
  /// Selects a light with the given probabilities. `u`: a random number in [0, 1). Several selections with
  /// u = (k + offset) / n for k = 0 .. n-1 form a systematic sample.
  static Choice choose(std::span<const float> probabilities, float u);

  /// Writes the probability of selecting each light to `out`: size() entries, which sum to 1, or are all 0 if
  /// no light can contribute. 90 % of the probability is proportional to Light::importance(). The rest is
  /// uniform over the lights that can contribute.
  void probabilities(const V3f& from, std::span<float> out) const;

  /// As probabilities() without `lobes`, but lights in directions of strong scattering are selected more
  /// often. `lobes(direction)` must return the density of scattering per solid angle. Without this, the
  /// brightest noise of paths through fur would come from narrow lobes that point at small bright lights with
  /// a low probability of selection. Half of each importance ignores the density, because the density towards
  /// the middle of a large light differs from the density towards the rest of it.
  ///
  /// The importance has no factor that bounds cos(theta_i). Such a factor would lower the importance of
  /// lights in the direction of the fibre. But when the fibre is seen at a slant, R, TT and TRT scatter light
  /// from these directions as brightly as light from others.
  ///
  /// `reaches(light)`: whether the light illuminates the point; others have probability 0.
  template <class Density, class Reaches>
  void probabilities(const V3f& from, const Density& lobes, const Reaches& reaches,
                     std::span<float> out) const {
    importances(from, out);
    for (size_t i = 0; i < size(); ++i) {
      if (!(out[i] > 0.0f)) continue;
      if (!reaches(*lights_[i])) out[i] = 0;
      if (!(out[i] > 0.0f) || size() == 1) continue;
      const std::optional<LightBall> ball = lights_[i]->ball();
      if (ball) out[i] *= towards_lobes(ball->center - from, lobes);
    }
    normalise(out);
  }

  template <class Density>
  void probabilities(const V3f& from, const Density& lobes, std::span<float> out) const {
    probabilities(
        from, lobes, [](const Light&) { return true; }, out);
  }

  /// Scenes with more lights at finite distances select among nodes of a tree, and then within the node.
  static constexpr size_t kMaxListed = 8;

  /// Computes the probabilities of selecting each light at a point. With up to kMaxListed lights at
  /// finite distances, they are those of probabilities(). Otherwise, the first choice is among far lights and
  /// nodes of a cut of the tree, by the same rule, and the tree chooses the light. So `lobes` is called at
  /// most LightTree::kMaxCut times.
  ///
  /// The tree does not know which lights reach a point: it may choose lights that do not.
  template <class Density, class Reaches>
  void prepare(const V3f& from, const Density& lobes, const Reaches& reaches, LightChoices& choices) const;
  template <class Density>
  void prepare(const V3f& from, const Density& lobes, LightChoices& choices) const {
    prepare(
        from, lobes, [](const Light&) { return true; }, choices);
  }
  /// Selects a light for each random number, as choose() above. A tree selects many at once in less time.
  void choose(LightChoices& choices, std::span<const float> u, std::span<Choice> chosen) const;
  /// Returns the probability that choose() selects a light.
  float probability(const LightChoices& choices, size_t light) const;

  /// Calls `visit(light)` for all lights that a ray may meet, and perhaps for others. `distance`: length of
  /// the ray; if it is finite, lights that are infinitely far are left out.
  template <class Visit>
  void on_ray(const V3f& origin, const V3f& direction, float distance, const Visit& visit) const;

  /// Lights are divided into groups, for estimates that need not know each light. With up to kMaxListed
  /// lights at finite distances, each light is a group. Otherwise, the far lights are one group, and
  /// neighbours are others.
  size_t groups() const { return group_count_; }
  size_t group(size_t light) const { return groups_[light]; }

 private:
  /// Factor of the importance of a light for the scattering in its direction, see probabilities().
  template <class Density>
  static float towards_lobes(const V3f& to, const Density& lobes) {
    return to == V3f(0) ? 1.0f : 0.5f + 0.5f * (4 * kPi * lobes(to.normalized()));
  }
  void importances(const V3f& from, std::span<float> out) const;
  /// Converts importances to probabilities in place.
  static void normalise(std::span<float> out);

  std::vector<std::unique_ptr<Light>> lights_;
  LightTree tree_;                // empty with up to kMaxListed lights at finite distances
  std::vector<uint32_t> far_;     // lights that are infinitely far
  std::vector<uint32_t> groups_;  // by light
  size_t group_count_ = 0;
  bool any_visible_ = false;
};

template <class Density, class Reaches>
void LightSet::prepare(const V3f& from, const Density& lobes, const Reaches& reaches,
                       LightChoices& choices) const {
  choices.from = from;
  if (tree_.empty()) {
    choices.probabilities.resize(size());
    probabilities(from, lobes, reaches, choices.probabilities);
    return;
  }
  tree_.cut(from, choices.cut, choices.importances);
  choices.probabilities.clear();
  for (const uint32_t light : far_)
    choices.probabilities.push_back(reaches(*lights_[light]) ? lights_[light]->importance(from) : 0.0f);
  for (size_t i = 0; i < choices.cut.size(); ++i) {
    const float importance = choices.importances[i];
    const float lobe = importance > 0 ? towards_lobes(tree_.center(choices.cut[i]) - from, lobes) : 0.0f;
    choices.probabilities.push_back(importance * lobe);
  }
  normalise(choices.probabilities);
}

template <class Visit>
void LightSet::on_ray(const V3f& origin, const V3f& direction, float distance, const Visit& visit) const {
  if (tree_.empty()) {
    for (size_t i = 0; i < size(); ++i) {
      if (!lights_[i]->is_infinitely_far() || std::isinf(distance)) visit(i);
    }
    return;
  }
  for (size_t i = 0; std::isinf(distance) && i < far_.size(); ++i) visit(size_t{far_[i]});
  tree_.on_line(origin, direction, visit);
}

}  // namespace pelage
