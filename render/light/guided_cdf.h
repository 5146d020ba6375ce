// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pelage {

// Discrete distributions as inclusive cumulative sums in floats, with a guide that says where to begin
// looking [Chen74], so that a draw takes a few steps whatever the length.

/// Entries of the guide of a distribution of `count` entries.
inline size_t guide_size(size_t count) { return count / 16 + 1; }

/// Turns weights (not negative, finite) in place into a cumulative distribution that ends in exactly 1, all
/// equal when every weight is 0, and fills its guide. Returns the sum of the weights.
double make_guided_cdf(std::span<float> weights, std::span<uint32_t> guide);

/// A drawn entry and `u` stretched to [0, 1) within it.
struct GuidedSample {
  size_t index;
  float rest;
};
/// Never gives an entry of weight zero, unless all are.
GuidedSample sample_guided(std::span<const float> cdf, std::span<const uint32_t> guide, float u);

}  // namespace pelage
