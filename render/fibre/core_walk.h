// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/hash.h"
#include "base/vector.h"
#include "render/sampling/warp.h"

namespace pelage {

/// Independent random numbers for one walk. They are a function of the seed.
class WalkRandom {
 public:
  explicit WalkRandom(uint64_t seed) : state_(mix64(seed)) {}
  float unit() { return unit_float(mix64(state_ += 0x9e3779b97f4a7c15ull)); }
  /// Returns a random free path length in a medium with the scattering coefficient `sigma`.
  float free_path(float sigma) { return -std::log(1 - unit()) / sigma; }

 private:
  uint64_t state_;
};

/// A position in the cross-section of a cylinder along x, and a unit direction of travel.
struct CoreWalk {
  V2f position{0};
  V3f direction{0, 1, 0};

  void advance(float length) { position += length * V2f(direction.y, direction.z); }

  /// Returns the distance along `direction` to the exit from the cylinder of `radius`. The position must be
  /// inside.
  float length_out(float radius) const {
    const Line line = about(radius);
    return std::max(0.0f, (std::sqrt(std::max(0.0f, line.discriminant)) - line.b) / line.a);
  }
  /// Returns the distance along `direction` to the entry into the cylinder of `radius`. The position must be
  /// outside. Empty when the ray from the position misses the cylinder.
  std::optional<float> length_in(float radius) const {
    const Line line = about(radius);
    if (!(line.discriminant > 0) || line.b >= 0) return std::nullopt;
    return std::max(0.0f, (-line.b - std::sqrt(line.discriminant)) / line.a);
  }

  /// Walks from the surface of a scattering cylinder of `radius` until the walk leaves the cylinder, using
  /// free paths and the phase function of Henyey-Greenstein with mean cosine `g`. Adds the travelled distance
  /// to `length`. Returns whether the walk was scattered at least once.
  bool cross(float radius, float sigma, float g, WalkRandom& random, float& length) {
    bool scattered = false;
    for (;;) {
      const float out = length_out(radius);
      const float free = sigma > 0 ? random.free_path(sigma) : out;
      length += std::min(free, out);
      advance(std::min(free, out));
      if (free >= out) return scattered;
      scatter(g, random);
      scattered = true;
    }
  }

 private:
  struct Line {
    float a, b, discriminant;
  };
  Line about(float radius) const {
    const V2f d(direction.y, direction.z);
    const float a = std::max(d.length2(), 1e-10f);
    const float b = position.dot(d);
    // a r^2 - (position x d)^2 equals b^2 - a c without its cancellation.
    const float cross = position.x * d.y - position.y * d.x;
    return {a, b, a * radius * radius - cross * cross};
  }

  void scatter(float g, WalkRandom& random) {
    const float xi = random.unit();
    float cosine = 2 * xi - 1;
    if (std::abs(g) > 1e-3f) {
      const float q = (1 - g * g) / (1 - g + 2 * g * xi);
      cosine = std::clamp((1 + g * g - q * q) / (2 * g), -1.0f, 1.0f);
    }
    V3f x, y;
    complete_frame(direction, x, y);
    direction = polar_direction(x, y, direction, cosine, random.unit());
    direction.normalize();
  }
};

}  // namespace pelage
