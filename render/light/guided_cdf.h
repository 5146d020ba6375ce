// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pelage {

// Discrete distributions as inclusive cumulative sums in floats, with a guide table of starting points for
// the search [Chen74], so that sampling takes a few steps whatever the length.

/// Size of the guide of a distribution with `count` entries.
inline size_t guide_size(size_t count) { return count / 16 + 1; }

/// Converts weights (non-negative, finite) in place to a cumulative distribution that ends in exactly 1,
/// uniform when every weight is 0, and fills its guide. Returns the sum of the weights.
double make_guided_cdf(std::span<float> weights, std::span<uint32_t> guide);

/// A sampled entry and `u` rescaled to [0, 1) within it.
struct GuidedSample {
  size_t index;
  float rest;
};
/// Never returns an entry of weight zero, unless all weights are zero.
GuidedSample sample_guided(std::span<const float> cdf, std::span<const uint32_t> guide, float u);

}  // namespace pelage
