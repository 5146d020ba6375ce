// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "render/light/light.h"

namespace pelage {

/// The lights of a scene and the choice among them. Hit tests and pdfs include the choice, so that "light
/// selection also uses MIS". Thread safety: const members from any thread.
class LightSet {
 public:
  explicit LightSet(std::vector<std::unique_ptr<Light>> lights);

  size_t size() const { return lights_.size(); }
  const Light& light(size_t i) const { return *lights_[i]; }

  /// A light chosen with probability in proportion to its importance (mixed with 10 % of uniform choice).
  struct Choice {
    size_t light = 0;
    float probability = 0;  ///< 0 when no light can contribute
    float remapped = 0;     ///< `u` rescaled to [0, 1) within the choice
  };
  Choice choose(const V3f& from, const V3f& tangent, float u) const;
  float probability(const V3f& from, const V3f& tangent, size_t light) const;

 private:
  std::vector<std::unique_ptr<Light>> lights_;
};

}  // namespace pelage
