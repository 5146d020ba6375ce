// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "base/vector.h"

namespace pelage {

/// A direction towards a light.
struct LightSample {
  V3f direction{0};    ///< unit, from the shaded point to the light
  float distance = 0;  ///< infinity for an environment
  Rgb radiance{0};
  float pdf = 0;  ///< per solid angle, of this light alone (excluding the selection of the light)
  V3f normal{0};  ///< unit normal of the light at that point, on either side; null for an environment
};

/// Intersection of a ray with a light.
struct LightHit {
  float distance = std::numeric_limits<float>::infinity();
  Rgb radiance{0};
  V3f normal{0};  ///< as in LightSample
};

/// An emitter with an area. World space. Immutable. Thread safety: const members from any thread.
class Light {
 public:
  virtual ~Light() = default;
  const std::string& name() const { return name_; }
  /// Whether camera rays see it.
  bool visible() const { return visible_; }
  /// Samples a direction; empty when no light can reach `from`.
  virtual std::optional<LightSample> sample(const V3f& from, const V2f& u) const = 0;
  /// Density of sample() for `direction`, using the same strategy.
  virtual float pdf(const V3f& from, const V3f& direction) const = 0;
  /// The light along a ray (unit direction) that leaves the scene or ends beyond the light.
  virtual std::optional<LightHit> intersect(const V3f& from, const V3f& direction) const = 0;
  /// Solid angle x mean radiance (luminance) as seen from `from`: the weight for selecting among lights
  /// ["Rendering Fur in Life of Pi", stochastic light selection].
  virtual float importance(const V3f& from) const = 0;
  /// Unit direction from `from` to the centre of the light; empty when it surrounds the scene.
  virtual std::optional<V3f> middle(const V3f& from) const = 0;

 protected:
  Light(std::string name, bool visible) : name_(std::move(name)), visible_(visible) {}

 private:
  std::string name_;
  bool visible_;
};

}  // namespace pelage
