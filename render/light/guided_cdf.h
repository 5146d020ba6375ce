// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pelage {

// Discrete distributions, stored as inclusive cumulative sums of float. A guide table stores starting points
// for the search [Chen74], so that sampling takes a few steps, however many entries the distribution has.

/// Returns the count of entries of the guide table for a distribution with `count` entries.
inline size_t guide_size(size_t count) { return count / 16 + 1; }

/// Converts weights in place to a cumulative distribution whose last entry is exactly 1, and fills its guide
/// table. Weights must be finite and not negative. If all weights are 0, the distribution is uniform. Returns
/// the sum of the weights.
double make_guided_cdf(std::span<float> weights, std::span<uint32_t> guide);

/// A sampled entry.
struct GuidedSample {
  size_t index;
  float rest;  ///< `u` rescaled to [0, 1) within the entry
};
/// Samples an entry in proportion to its weight. `u`: a random number in [0, 1). Never returns an entry of
/// weight 0, unless all weights are 0.
GuidedSample sample_guided(std::span<const float> cdf, std::span<const uint32_t> guide, float u);

}  // namespace pelage
