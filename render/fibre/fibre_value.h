// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

/// The groups of lobes for which images have separate layers. A model uses a subset; the physical models
/// count surface reflection (R) as primary, light that leaves after one internal reflection (TRT) as
/// secondary, and all other light that entered the fibre as diffuse.
enum class LobeGroup { kDiffuse, kPrimary, kSecondary, kCount };
inline constexpr int kLobeGroups = static_cast<int>(LobeGroup::kCount);
inline constexpr const char* kLobeGroupNames[kLobeGroups] = {"diffuse", "primary", "secondary"};

/// Scattering of a fibre for a pair of directions: the throughput density rho = f cos(theta_i) per solid
/// angle (cosine of the inclination, not of a normal), by lobe group. Outgoing radiance is the integral of
/// rho * L_in over the whole sphere, without a further cosine.
struct FibreValue {
  Rgb lobes[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};
  float pdf = 0;  ///< density of sample(), per solid angle

  Rgb& operator[](LobeGroup group) { return lobes[static_cast<int>(group)]; }
  Rgb total() const { return lobes[0] + lobes[1] + lobes[2]; }
};

struct FibreSample {
  V3f wi{0};
  FibreValue value;  ///< eval(wi), the whole mixture
};

}  // namespace pelage
