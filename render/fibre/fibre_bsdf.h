// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/vector.h"

namespace pelage {

/// Groups of lobes that images are split by. A model uses those it has.
enum class LobeGroup { kDiffuse, kPrimary, kSecondary, kCount };
inline constexpr int kLobeGroups = static_cast<int>(LobeGroup::kCount);
inline constexpr const char* kLobeGroupNames[kLobeGroups] = {"diffuse", "primary", "secondary"};

/// Value of a fibre's scattering for a pair of directions: the throughput density rho = f cos(theta_i) per
/// solid angle (cos of the inclination, not of any normal), by lobe group, so that radiance out = integral
/// over the whole sphere of rho * L_in. No further cosine is due.
struct FibreValue {
  Rgb lobes[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};
  float pdf = 0;  ///< of the mixture that sample() draws from, per solid angle

  Rgb total() const { return lobes[0] + lobes[1] + lobes[2]; }
};

struct FibreSample {
  V3f wi{0};
  FibreValue value;  ///< eval() of wi, the whole mixture
};

/// Scattering of one fibre at one point for one outgoing direction.
///
/// Conventions: directions are unit, in world space, and point away from the strand: wo to the viewer or
/// previous vertex (given when the value is made), wi to the light or next vertex; wi is what is sampled.
/// Inclination theta is measured from the normal plane: sin theta = dot(w, T), T the unit tangent from root
/// to tip.
class FibreBsdf {
 public:
  virtual ~FibreBsdf() = default;
  virtual FibreValue eval(const V3f& wi) const = 0;
  /// Draws wi from the mixture; `u` are three numbers in [0, 1). Nothing when the fibre absorbs all.
  virtual std::optional<FibreSample> sample(const V3f& u) const = 0;
  /// Integral of rho over the sphere of wi.
  virtual Rgb albedo() const = 0;
};

}  // namespace pelage
