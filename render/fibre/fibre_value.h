// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

/// The groups of lobes for which images have separate layers. A model need not use all groups. The physical
/// models count light that the surface reflects (R) as primary, light that leaves after one internal
/// reflection (TRT) as secondary, and all other light that entered the fibre as diffuse.
enum class LobeGroup { kDiffuse, kPrimary, kSecondary, kCount };
inline constexpr int kLobeGroups = static_cast<int>(LobeGroup::kCount);
inline constexpr const char* kLobeGroupNames[kLobeGroups] = {"diffuse", "primary", "secondary"};

/// Scattering of a fibre for a pair of directions. For each lobe group, it is the throughput density rho = f
/// cos(theta_i) per solid angle, where theta_i is the inclination to the normal plane, not the angle to a
/// surface normal. Outgoing radiance is the integral of rho * L_in over the whole sphere, without a further
/// cosine.
struct FibreValue {
  Rgb lobes[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};
  float pdf = 0;  ///< density of sample(), per solid angle
  /// `pdf` / density of sampling the lobes alone: more where magnets attract rays (MagnetSet).
  float attraction = 1;

  Rgb& operator[](LobeGroup group) { return lobes[static_cast<int>(group)]; }
  Rgb total() const { return lobes[0] + lobes[1] + lobes[2]; }
};

struct FibreSample {
  V3f wi{0};
  FibreValue value;  ///< eval(wi): all lobes, not only the sampled one
};

}  // namespace pelage
