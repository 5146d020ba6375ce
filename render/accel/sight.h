// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>

#include "render/accel/accel.h"

namespace pelage {

/// The distances from the origin of a secondary ray at which the ray sees a chunk. A coat may have two sets
/// of chunks: one with all strands, which such rays see near their origin, and one with fewer and wider
/// strands, which they see from there on.
struct SightRange {
  float from = 0, to = std::numeric_limits<float>::infinity();

  /// Whether only secondary rays see the chunk.
  bool is_distant() const { return from > 0; }
  bool is_empty() const { return from > to; }
};

/// The part of one ray in which the ray sees each chunk.
class Sight {
 public:
  /// `ranges`: by chunk; empty if all rays see all chunks everywhere.
  Sight(std::span<const SightRange> ranges, const Ray& ray) : ranges_(ranges), ray_(ray) {}

  /// Whether there are chunks that the ray does not see everywhere.
  bool is_limited() const { return !ranges_.empty(); }
  /// Returns an empty range for a chunk that the ray does not see.
  SightRange of(uint32_t chunk) const {
    if (!is_limited()) return {};
    const SightRange range = ranges_[chunk];
    if (ray_.secondary && !ray_.start.distant) return range;
    const bool is_alone = !range.is_distant() && range.to == kEverywhere.to;
    return is_alone || range.is_distant() == ray_.secondary ? kEverywhere : kNowhere;
  }
  /// Returns the part of the ray that is in a range.
  Ray part(const SightRange& range) const {
    Ray part = ray_;
    part.near = std::max(ray_.near, range.from);
    part.far = std::min(ray_.far, range.to);
    return part;
  }

 private:
  static constexpr SightRange kEverywhere{}, kNowhere{std::numeric_limits<float>::infinity(), 0};

  const std::span<const SightRange> ranges_;
  const Ray& ray_;
};

}  // namespace pelage
