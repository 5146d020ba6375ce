// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "base/vector.h"
#include "render/fibre/fibre_tracer.h"

namespace pelage {

/// How far scattered light has travelled in the cortex and in the medulla, in radii: the means of groups of
/// paths, from the shortest to the longest. One mean of all would be too dark for strong absorption, of which
/// short paths are what is left.
class PathLengths {
 public:
  PathLengths() = default;
  /// Of traced paths; their order does not matter beyond equal lengths.
  explicit PathLengths(std::vector<FibrePath> paths);

  /// The mean of exp(-sigma . length).
  Rgb transmittance(const Rgb& sigma_ca, const Rgb& sigma_ma) const;

  float mean_cortex() const { return mean(cortex_); }
  float mean_core() const { return mean(core_); }

  /// Halfway lengths: `t` = 0 is a, 1 is b.
  static PathLengths mix(const PathLengths& a, const PathLengths& b, float t);

 private:
  static constexpr int kGroups = 9;
  static constexpr std::array<float, kGroups> kShares = {1 / 32.0f, 1 / 32.0f, 1 / 16.0f, 1 / 8.0f, 1 / 4.0f,
                                                         1 / 4.0f,  1 / 8.0f,  1 / 16.0f, 1 / 16.0f};
  static float mean(const std::array<float, kGroups>& lengths);

  std::array<float, kGroups> cortex_{}, core_{};
};

}  // namespace pelage
