// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "render/light/light.h"
#include "render/sampling/warp.h"

namespace pelage {

/// The lights of a scene, and random selection among them. For MIS, callers must multiply the pdf of a light
/// by the probability of selecting the light, also when a scattered ray hits the light by chance. Thread
/// safety: const members may be called from any thread.
class LightSet {
 public:
  explicit LightSet(std::vector<std::unique_ptr<Light>> lights);

  size_t size() const { return lights_.size(); }
  const Light& light(size_t i) const { return *lights_[i]; }

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
  template <class Density>
  void probabilities(const V3f& from, const Density& lobes, std::span<float> out) const {
    importances(from, out);
    for (size_t i = 0; i < size() && size() > 1; ++i) {
      if (!(out[i] > 0.0f)) continue;
      const std::optional<V3f> middle = lights_[i]->middle(from);
      if (middle) out[i] *= 0.5f + 0.5f * (4 * kPi * lobes(*middle));
    }
    normalise(out);
  }

 private:
  void importances(const V3f& from, std::span<float> out) const;
  /// Converts importances to probabilities in place.
  static void normalise(std::span<float> out);

  std::vector<std::unique_ptr<Light>> lights_;
};

}  // namespace pelage
