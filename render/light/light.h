// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/vector.h"
#include "render/light/part_set.h"

namespace pelage {

/// A sampled direction towards a light.
struct LightSample {
  V3f direction{0};    ///< unit, from the shaded point to the light
  float distance = 0;  ///< infinity for an environment
  Rgb radiance{0};
  float pdf = 0;  ///< per solid angle, without the probability of selecting the light
  V3f normal{0};  ///< unit, of the light at the sampled point, on either side; zero for an environment
};

/// Intersection of a ray with a light.
struct LightHit {
  float distance = std::numeric_limits<float>::infinity();
  Rgb radiance{0};
  V3f normal{0};  ///< as LightSample::normal
};

/// A ball around a light.
struct LightBall {
  V3f center{0};
  float radius = 0;
};

/// An emitter with an area, or an environment. World space. Immutable. Thread safety: const members may be
/// called from any thread.
class Light {
 public:
  virtual ~Light() = default;
  const std::string& name() const { return name_; }
  /// Returns whether camera rays see the light.
  bool visible() const { return visible_; }

  /// Limits the coats and skins that receive the light, and those that cast shadows in it. Null: all.
  void link(std::shared_ptr<const PartSet> receivers, std::shared_ptr<const PartSet> casters) {
    receivers_ = std::move(receivers);
    if (!casters_ || !casters_->empty()) casters_ = std::move(casters);
  }
  /// From now on, nothing casts a shadow in this light, whatever link() says.
  void omit_shadows() { casters_ = std::make_shared<const PartSet>(); }
  bool illuminates(const FramePart& part) const { return !receivers_ || receivers_->contains(part); }
  /// Returns the parts that cast shadows in this light; null: all. If some do not, rays that are sampled from
  /// lobes ignore the light, because they do not pass through these parts: only light sampling finds it.
  const PartSet* casters() const { return casters_.get(); }

  /// Returns whether the light is infinitely far away, so that any surface on a line to it is nearer.
  virtual bool is_infinitely_far() const { return false; }
  /// Samples a direction from `from` to the light; empty when its light cannot reach `from`. `u`: two random
  /// numbers in [0, 1).
  virtual std::optional<LightSample> sample(const V3f& from, const V2f& u) const = 0;
  /// Returns the density of sample() for `direction`, per solid angle.
  virtual float pdf(const V3f& from, const V3f& direction) const = 0;
  /// Returns the same as pdf(). `hit`: the result of intersect() for the same line; some lights need no
  /// second search then.
  virtual float pdf_of_hit(const V3f& from, const V3f& direction, const LightHit& /*hit*/) const {
    return pdf(from, direction);
  }
  /// Intersects the light with an infinite ray. `direction`: unit. Empty when no light of this emitter
  /// arrives at `from` along the ray.
  virtual std::optional<LightHit> intersect(const V3f& from, const V3f& direction) const = 0;
  /// Intersects the light with a camera ray at a shutter time. Lights that show an image filter it here.
  virtual std::optional<LightHit> seen(const V3f& from, const V3f& direction, float /*time*/) const {
    return intersect(from, direction);
  }
  /// Returns the weight for selecting among lights: solid angle * mean luminance of the light, as seen from
  /// `from` ["Rendering Fur in Life of Pi", stochastic light selection].
  virtual float importance(const V3f& from) const = 0;
  /// Returns the smallest ball around the light; empty if the light is infinitely far away.
  virtual std::optional<LightBall> ball() const = 0;

 protected:
  Light(std::string name, bool visible) : name_(std::move(name)), visible_(visible) {}

 private:
  std::string name_;
  bool visible_;
  std::shared_ptr<const PartSet> receivers_, casters_;
};

}  // namespace pelage
