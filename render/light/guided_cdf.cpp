// SPDX-License-Identifier: Apache-2.0
#include "render/light/guided_cdf.h"

#include <algorithm>

#include "render/sampling/warp.h"

namespace pelage {
namespace {

/// Returns the index of the first entry above `u` from `low` on; `high` if there is none before it. The loop
/// has no branch that depends on the entries, so the processor need not wait for one entry to ask for the
/// next: several searches in large tables overlap.
size_t first_above(std::span<const float> cdf, size_t low, size_t high, float u) {
  for (size_t count = high - low; count > 0;) {
    const size_t half = count / 2;
    const bool above = cdf[low + half] > u;
    low = above ? low : low + half + 1;
    count = above ? half : count - half - 1;
  }
  return low;
}

}  // namespace

double make_guided_cdf(std::span<float> weights, std::span<uint32_t> guide) {
  double total = 0;
  for (float w : weights) total += w;
  double sum = 0;
  size_t last = weights.size() - 1;
  if (total > 0) {
    while (weights[last] == 0) --last;
  }
  for (size_t i = 0; i < weights.size(); ++i) {
    sum += total > 0 ? weights[i] / total : 1.0 / static_cast<double>(weights.size());
    weights[i] = i >= last ? 1.0f : std::min(static_cast<float>(sum), 1.0f);
  }
  size_t i = 0;
  for (size_t g = 0; g < guide.size(); ++g) {
    const float start = static_cast<float>(g) / static_cast<float>(guide.size());
    while (i < weights.size() - 1 && weights[i] <= start) ++i;
    guide[g] = static_cast<uint32_t>(i);
  }
  return total;
}

GuidedSample sample_guided(std::span<const float> cdf, std::span<const uint32_t> guide, float u) {
  const size_t cell = std::min(static_cast<size_t>(u * static_cast<float>(guide.size())), guide.size() - 1);
  // Rounding may have put u into the cell after its own: the previous entry is then the right one.
  size_t low = guide[cell];
  while (low > 0 && cdf[low - 1] > u) --low;
  size_t high = cell + 1 < guide.size() ? std::min<size_t>(guide[cell + 1] + 1, cdf.size()) : cdf.size();
  while (high < cdf.size() && cdf[high - 1] <= u) ++high;
  const size_t index = std::min(first_above(cdf, low, high, u), cdf.size() - 1);
  const float before = index > 0 ? cdf[index - 1] : 0.0f;
  const float width = cdf[index] - before;
  return {index, width > 0 ? std::clamp((u - before) / width, 0.0f, kBelowOne) : u};
}

}  // namespace pelage
