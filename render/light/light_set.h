// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "render/light/light.h"
#include "render/sampling/warp.h"

namespace pelage {

/// The lights of a scene, and random selection among them. Callers multiply the pdf of a light by the
/// probability of its selection, also when a scattered ray hits the light, so that MIS accounts for the
/// selection. Thread safety: const members from any thread.
class LightSet {
 public:
  explicit LightSet(std::vector<std::unique_ptr<Light>> lights);

  size_t size() const { return lights_.size(); }
  const Light& light(size_t i) const { return *lights_[i]; }

  /// A light selected with probability proportional to its importance (mixed with 10 % of uniform selection
  /// among the lights that can contribute at all). Uses one random number, so that several selections with u
  /// = (k + offset) / n form a systematic sample.
  struct Choice {
    size_t light = 0;
    float probability = 0;  ///< 0 when no light can contribute
    float remapped = 0;     ///< `u` rescaled to [0, 1) within the choice
  };
  static Choice choose(std::span<const float> probabilities, float u);

  /// Writes the probabilities of all lights to `out`: size() entries, which sum to 1 or are all 0.
  void probabilities(const V3f& from, std::span<float> out) const;

  /// The same for lobes that scatter with density `lobes(direction)` per solid angle: lights in directions of
  /// strong scattering are selected more often. Otherwise, narrow lobes that point at small bright lights
  /// with a low probability of selection would cause the brightest noise of paths through fur. Half of each
  /// importance ignores the density, since the density towards the middle of a large light differs from the
  /// density towards the rest of the light. Importances have no factor that bounds cos(theta_i). Such a
  /// factor would lower the importance of lights along the fibre. But when the fibre is seen at a slant, R,
  /// TT and TRT scatter light from there as brightly as from other directions.
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
  /// Normalises importances to probabilities.
  static void normalise(std::span<float> out);

  std::vector<std::unique_ptr<Light>> lights_;
};

}  // namespace pelage
