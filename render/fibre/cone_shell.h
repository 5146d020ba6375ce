// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "render/fibre/wigner.h"
#include "render/material/material.h"

namespace pelage {

/// Material constants: width and tilt of a specular shell with their sines and cosines.
struct ShellShape {
  /// Half width in [1, 90] degrees; tilt in degrees, added to the polar angle of the middle cone.
  ShellShape(float half_width_degrees, float tilt_degrees);

  float half_width;  ///< radians
  float cos_width, sin_width;
  float cos_tilt, sin_tilt;
};

/// Sampling strategies for the directions of a shell. Estimates have the same expected value with each
/// strategy. Rendering uses kMatched.
enum class ShellSampler {
  kMatched,  ///< in proportion to the shell's own density
  kUniform,  ///< uniform in solid angle inside the shell, as in the slides of [Neulander13]
  kTent,     ///< the older piecewise-linear density, see tent_pdf()
};

/// A sampled polar cosine z, and the density (with respect to z) with which it was sampled.
struct ShellPoint {
  float z;
  float pdf;
};

/// The specular lobe of the cone-shell model [Neulander10, Neulander13]: a density over the directions
/// between two cones about a tangent T. Its integral over the sphere is 1.
///
/// A cylinder reflects into the cone that mirrors the inclination of wo: the middle cone has polar angle
/// Theta_mid = acos(-sin theta_o) + tilt. The shell extends by half_width to either side of the middle cone
/// and is cut off at the poles. The density is proportional to a weight, which depends on the variant. The
/// weight of the literal variant is cos(Theta - Theta_mid) in the whole shell, as in the slides of
/// [Neulander13]. The weight of the Wigner variant is sqrt(1 - u^2), where u in [-1, 1] is the relative
/// position of z = cos Theta between the two bounding cones. This weight is zero at the bounding cones and
/// proportional to the density of the Wigner sampler. Both variants are uniform in azimuth.
class ConeShell {
 public:
  ConeShell(const ShellShape& shape, ShellVariant variant, float sin_theta_o);

  /// Returns the throughput density of a white lobe at z = dot(wi, T), per solid angle. Directions with z
  /// from sample() and a uniform azimuth have the same density.
  float density(float z) const {
    const float from_center = (z - center_) * inverse_half_range_;
    const float inside = 1.0f - from_center * from_center;
    if (!(inside > 0.0f)) return 0.0f;
    if (variant_ == ShellVariant::kWigner) return scale_ * std::sqrt(inside);
    const float weight = z * cos_mid_ + std::sqrt(std::max(0.0f, (1.0f - z) * (1.0f + z))) * sin_mid_;
    return scale_ * std::max(0.0f, weight);
  }

  /// Returns z, sampled with the density 2 pi density(z) with respect to z.
  float sample(float xi) const {
    if (variant_ == ShellVariant::kLiteral) return sample_literal(xi);
    return std::clamp(center_ + half_range_ * WignerTable::instance().sample(xi), -1.0f, 1.0f);
  }
  /// Samples z with the given sampler. Returns z and its density under this sampler.
  ShellPoint sample(ShellSampler sampler, float xi) const;

  /// Range of z: cosines of the outer and the inner cone.
  float z_min() const { return center_ - half_range_; }
  float z_max() const { return center_ + half_range_; }

 private:
  float sample_literal(float xi) const;

  ShellVariant variant_;
  float cos_mid_, sin_mid_;
  float below_, above_;  ///< extent of the shell towards smaller and larger Theta, radians (literal only)
  float center_, half_range_, inverse_half_range_;
  float scale_;  ///< normalises the weight
};

}  // namespace pelage
