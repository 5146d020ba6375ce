// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "base/vector.h"
#include "render/fibre/fibre_tracer.h"

namespace pelage {

/// Path lengths of scattered light in the cortex and in the medulla, in radii. Paths are sorted by length and
/// divided into groups; each group stores its mean lengths. With a single mean over all paths, strongly
/// absorbing fibres would be too dark, because only their short paths contribute.
class PathLengths {
 public:
  PathLengths() = default;
  /// Computes the groups of traced paths. The order of `paths` matters only among paths of equal length.
  explicit PathLengths(std::vector<FibrePath> paths);

  /// Returns the mean over all groups of exp(-sigma_ca cortex - sigma_ma core), weighted by the groups'
  /// fractions of all paths.
  Rgb transmittance(const Rgb& sigma_ca, const Rgb& sigma_ma) const;

  float mean_cortex() const { return mean(cortex_); }
  float mean_core() const { return mean(core_); }

  /// Interpolates the lengths of each group linearly: `t` = 0 gives a, `t` = 1 gives b.
  static PathLengths mix(const PathLengths& a, const PathLengths& b, float t);

 private:
  static constexpr int kGroups = 9;
  static constexpr std::array<float, kGroups> kShares = {1 / 32.0f, 1 / 32.0f, 1 / 16.0f, 1 / 8.0f, 1 / 4.0f,
                                                         1 / 4.0f,  1 / 8.0f,  1 / 16.0f, 1 / 16.0f};
  static float mean(const std::array<float, kGroups>& lengths);

  std::array<float, kGroups> cortex_{}, core_{};
};

}  // namespace pelage
