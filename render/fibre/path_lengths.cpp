// SPDX-License-Identifier: Apache-2.0
#include "render/fibre/path_lengths.h"

#include <algorithm>
#include <cmath>

namespace pelage {

PathLengths::PathLengths(std::vector<FibrePath> paths) {
  if (paths.empty()) return;
  std::stable_sort(paths.begin(), paths.end(), [](const FibrePath& a, const FibrePath& b) {
    return a.cortex + a.core < b.cortex + b.core;
  });
  double share = 0;
  size_t begin = 0;
  for (int g = 0; g < kGroups; ++g) {
    share += kShares[g];
    const auto end = static_cast<size_t>(share * static_cast<double>(paths.size()));
    double cortex = 0, core = 0;
    for (size_t i = begin; i < end; ++i) {
      cortex += paths[i].cortex;
      core += paths[i].core;
    }
    const double count = std::max(1.0, static_cast<double>(end - begin));
    cortex_[g] = static_cast<float>(cortex / count);
    core_[g] = static_cast<float>(core / count);
    begin = end;
  }
}

Rgb PathLengths::transmittance(const Rgb& sigma_ca, const Rgb& sigma_ma) const {
  Rgb result(0);
  for (int g = 0; g < kGroups; ++g) {
    for (int c = 0; c < 3; ++c)
      result[c] += kShares[g] * std::exp(-sigma_ca[c] * cortex_[g] - sigma_ma[c] * core_[g]);
  }
  return result;
}

PathLengths PathLengths::mix(const PathLengths& a, const PathLengths& b, float t) {
  PathLengths result;
  for (int g = 0; g < kGroups; ++g) {
    result.cortex_[g] = a.cortex_[g] + t * (b.cortex_[g] - a.cortex_[g]);
    result.core_[g] = a.core_[g] + t * (b.core_[g] - a.core_[g]);
  }
  return result;
}

float PathLengths::mean(const std::array<float, kGroups>& lengths) {
  float sum = 0;
  for (int g = 0; g < kGroups; ++g) sum += kShares[g] * lengths[g];
  return sum;
}

}  // namespace pelage
