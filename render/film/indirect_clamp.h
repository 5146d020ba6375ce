// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/vector.h"
#include "render/fibre/fibre_value.h"

namespace pelage {

/// Limits the indirect light that a single path contributes (render.clamp_indirect), and counts the light
/// that the limit removes.
struct IndirectClamp {
  float limit = 0;  ///< max luminance of one contribution; 0: no limit
  /// Luminance that was removed, and all luminance before removal, in units of 1/65,536. They are integers so
  /// that the order of summation does not matter.
  int64_t lost = 0, indirect = 0;

  /// Counts a contribution, and returns the factor in [0, 1] that limits it. The contribution is the sum of
  /// lobes[g] * light over all lobe groups g.
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
  /// Returns the fraction of the indirect light that was removed; 0 if there was none.
  double lost_fraction() const {
    return indirect > 0 ? static_cast<double>(lost) / static_cast<double>(indirect) : 0;
  }

 private:
  static int64_t in_parts(float value) {
    if (!(value > 0)) return 0;  // NaN, too: the film rejects such samples
    return static_cast<int64_t>(std::min(double{value}, 1e9) * 65536);
  }
};

}  // namespace pelage
