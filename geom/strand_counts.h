// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

namespace pelage {

class Strands;

/// Number of elements of a batch of strands, known before the batch is grown.
struct StrandCounts {
  size_t strands = 0;
  size_t points = 0;    ///< number of points of all strands, for one motion key
  size_t longest = 0;   ///< number of points of the longest strand
  size_t segments = 0;  ///< number of segments of all strands
  size_t motion_keys = 1;
  size_t attribute_floats = 0;  ///< number of floats of all attributes
  StrandCounts& operator+=(const StrandCounts& other) {
    strands += other.strands;
    points += other.points;
    longest = std::max(longest, other.longest);
    segments += other.segments;
    if (other.motion_keys > motion_keys) motion_keys = other.motion_keys;
    attribute_floats += other.attribute_floats;
    return *this;
  }
};

/// Counts the elements of a batch that has been grown.
StrandCounts counts_of(const Strands& strands);

}  // namespace pelage
