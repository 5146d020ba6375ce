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
  float pdf = 0;  ///< per solid angle, of this light alone (the choice of the light not included)
  V3f normal{0};  ///< of the light at that point, unit, to either side; null for an environment
};

/// Where a ray meets a light.
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
  /// A direction by solid angle importance; nothing when the light cannot reach `from`.
  virtual std::optional<LightSample> sample(const V3f& from, const V2f& u) const = 0;
  /// Density with which sample() gives `direction`, by the branch that it would take.
  virtual float pdf(const V3f& from, const V3f& direction) const = 0;
  /// The light along a ray (unit direction), for rays that leave the geometry or end beyond the light.
  virtual std::optional<LightHit> intersect(const V3f& from, const V3f& direction) const = 0;
  /// Solid angle x average radiance (luminance) as seen from `from`: the weight for choosing among lights
  /// ["Rendering Fur in Life of Pi", stochastic light selection].
  virtual float importance(const V3f& from) const = 0;
  /// Unit direction from `from` to its middle; nothing where it shines from all around.
  virtual std::optional<V3f> middle(const V3f& from) const = 0;

 protected:
  Light(std::string name, bool visible) : name_(std::move(name)), visible_(visible) {}

 private:
  std::string name_;
  bool visible_;
};

}  // namespace pelage
