// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/path/indirect_clamp_test.cpp.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/vector.h"
#include "render/fibre/fibre_value.h"

namespace pelage {

/// Limit on the contribution of single paths (render.clamp_indirect), and the amount of light that it
/// removed.
struct IndirectClamp {
  float limit = 0;  ///< luminance; 0 is none
  int64_t lost = 0,
          indirect = 0;  ///< luminance in units of 1/65,536; integers, so that the order of summation does
                         ///< not matter

  /// Returns the factor to apply to light that reaches the camera. This light is the sum of lobes[g] * light
  /// over lobe groups g.
  float keep(const Rgb* lobes, const Rgb& light) {
    if (limit == 0) return 1;
    float all = 0;
    for (int g = 0; g < kLobeGroups; ++g) all += luminance(lobes[g] * light);
    const float kept = all > limit ? limit / all : 1;
    indirect += in_parts(all);
    lost += in_parts(all * (1 - kept));
    return kept;
  }

  /// Adds the counts of another clamp.
  void add_counts(const IndirectClamp& other) {
    lost += other.lost;
    indirect += other.indirect;
  }
  /// Fraction of the indirect light that was removed.
  double lost_fraction() const {
    return indirect > 0 ? static_cast<double>(lost) / static_cast<double>(indirect) : 0;
  }

 private:
  static int64_t in_parts(float value) {
    return static_cast<int64_t>(std::min(double{value}, 1e9) * 65536);  // 0 for NaN
  }
};

}  // namespace pelage
