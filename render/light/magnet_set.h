// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "render/light/light.h"

namespace pelage {

/// Shapes in space that attract rays, such as a window: a further technique for sampling the directions in
/// which rays leave a surface ["Rendering Fur in Life of Pi", ray magnets]. A magnet emits and blocks
/// nothing. A direction towards it is uniformly distributed over its solid angle.
///
/// One technique is selected for each ray, and the density of the ray is the mean of the densities of all
/// techniques, weighted by the probabilities of selecting them. This is the balance heuristic with one sample
/// in all [Veach97, section 9.2.4]. So magnets change no mean. Immutable. Thread safety: const members may be
/// called from any thread.
class MagnetSet {
 public:
  /// Min probability of sampling the lobes: magnets miss some of the directions from which light arrives.
  static constexpr float kLeastLobes = 0.1f;

  struct Magnet {
    std::unique_ptr<const Light> shape;  ///< a light of luminance 1, of which only the shape matters
    float share = 0;  ///< probability of selecting the magnet where it is in sight, from 0 to 1
  };

  MagnetSet() = default;
  explicit MagnetSet(std::vector<Magnet> magnets) : magnets_(std::move(magnets)) {}
  bool empty() const { return magnets_.empty(); }

  /// Returns the probability of selecting a magnet rather than the lobes at a point. 0 if no magnet is seen.
  float share(const V3f& from) const;
  /// Selects a magnet, and a direction towards it. `u`: three random numbers in [0, 1). share() must not be
  /// 0. Empty if rounding finds no direction.
  std::optional<V3f> sample(const V3f& from, const V3f& u) const;
  /// Returns share() times the density of sample(), per solid angle.
  float pdf(const V3f& from, const V3f& direction) const;

 private:
  /// Returns the probability of a magnet before the shares are scaled to leave kLeastLobes.
  static float wanted(const Magnet& magnet, const V3f& from) {
    return magnet.shape->importance(from) > 0 ? magnet.share : 0.0f;
  }
  float wanted(const V3f& from) const;

  std::vector<Magnet> magnets_;
};

}  // namespace pelage
