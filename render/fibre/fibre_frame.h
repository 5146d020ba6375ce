// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vector.h"
#include "render/sampling/warp.h"

namespace pelage {

/// A direction relative to a fibre: sine and cosine of its inclination, and its azimuth in [-pi, pi].
struct FibreAngles {
  float sin_theta = 0;
  float cos_theta = 1;
  float phi = 0;
};

/// Wraps an angle of at most a few turns to [-pi, pi].
inline float wrapped_angle(float x) { return x - 2 * kPi * std::round(x * (0.5f / kPi)); }

/// The frame of a fibre seen from `wo`. x points along the tangent. wo lies in the half plane of x and +y,
/// which has azimuth 0. The surface normal of a fibre hit at h is sqrt(1 - h^2) y - h z.
class FibreFrame {
 public:
  FibreFrame(const V3f& tangent, const V3f& wo) : x_(tangent) {
    const V3f across = tangent.cross(wo);
    const float length = across.length();
    if (length > 1e-6f) {
      z_ = across / length;
      y_ = z_.cross(tangent);
    } else {
      complete_frame(tangent, y_, z_);
    }
    sin_theta_o_ = std::clamp(wo.dot(tangent), -1.0f, 1.0f);
    cos_theta_o_ = std::max(length, 1e-4f);
  }

  float sin_theta_o() const { return sin_theta_o_; }
  /// At least 1e-4: models divide by it.
  float cos_theta_o() const { return cos_theta_o_; }

  FibreAngles angles(const V3f& w) const {
    const float y = w.dot(y_), z = w.dot(z_);
    return {w.dot(x_), std::sqrt(y * y + z * z), std::atan2(z, y)};
  }
  V3f direction(float sin_theta, float cos_theta, float phi) const {
    return sin_theta * x_ + (cos_theta * std::cos(phi)) * y_ + (cos_theta * std::sin(phi)) * z_;
  }
  V3f to_local(const V3f& w) const { return {w.dot(x_), w.dot(y_), w.dot(z_)}; }
  V3f to_world(const V3f& w) const { return w.x * x_ + w.y * y_ + w.z * z_; }

 private:
  V3f x_, y_, z_;
  float sin_theta_o_, cos_theta_o_;
};

}  // namespace pelage
