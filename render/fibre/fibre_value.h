// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

/// Groups of lobes that images are split by. A model uses those it has; the physical ones count what the
/// surface reflects (R) as primary, what comes back after one internal reflection (TRT) as secondary, and
/// everything else that has been inside the fibre as diffuse.
enum class LobeGroup { kDiffuse, kPrimary, kSecondary, kCount };
inline constexpr int kLobeGroups = static_cast<int>(LobeGroup::kCount);
inline constexpr const char* kLobeGroupNames[kLobeGroups] = {"diffuse", "primary", "secondary"};

/// Value of a fibre's scattering for a pair of directions: the throughput density rho = f cos(theta_i) per
/// solid angle (cos of the inclination, not of any normal), by lobe group, so that radiance out = integral
/// over the whole sphere of rho * L_in. No further cosine is due.
struct FibreValue {
  Rgb lobes[kLobeGroups] = {Rgb(0), Rgb(0), Rgb(0)};
  float pdf = 0;  ///< of the mixture that sample() draws from, per solid angle

  Rgb& operator[](LobeGroup group) { return lobes[static_cast<int>(group)]; }
  Rgb total() const { return lobes[0] + lobes[1] + lobes[2]; }
};

struct FibreSample {
  V3f wi{0};
  FibreValue value;  ///< eval() of wi, the whole mixture
};

}  // namespace pelage
