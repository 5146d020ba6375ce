// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/strands.h"
#include "render/accel/embree_accel.h"

namespace pelage {

/// Control points of a batch of strands as Embree reads them, and the way back from its primitives to
/// strands.
///
/// Unpinned B-splines and linear strands are read in place; pinned B-splines and Catmull-Rom strands need a
/// copy with a phantom point at each end.
///
/// Flat segments are tested in tessellation_rate straight pieces. Over 2 million camera rays on fur of 7
/// segments per strand, rates 4, 8 and 16 gave another answer than rate 64 for 3.9, 1.1 and 0.3 % of the rays
/// that hit, at equal cost for 4 and 8 (they fill one AVX register) and 10 % more for 16: hence 8.
class EmbreeCurves {
 public:
  explicit EmbreeCurves(const AccelStrands& source);

  const Strands& strands() const { return *source_.strands; }
  uint32_t part() const { return source_.part; }
  bool opaque() const { return source_.opacity.empty(); }

  /// x, y, z, radius of every control point of one motion key, 16-byte stride.
  const float* vertices(int key) const;
  size_t vertex_count() const { return vertex_count_; }
  /// First control point of each segment.
  std::span<const uint32_t> segments() const { return first_vertex_; }

  struct Place {
    uint32_t strand = 0;
    uint32_t segment = 0;
  };
  Place locate(uint32_t primitive) const;
  float opacity(Place place, float u) const;

  /// Heap bytes held here.
  size_t bytes() const;

 private:
  void copy_with_phantoms();

  AccelStrands source_;
  size_t vertex_count_ = 0;
  std::vector<float> copy_;                  // control points with phantom ends, or empty: read in place
  std::vector<uint32_t> first_vertex_;       // one per segment
  uint32_t segments_per_strand_ = 0;         // when all strands have equally many
  std::vector<uint32_t> strand_of_segment_;  // otherwise
  std::vector<uint32_t> first_segment_;      // otherwise: of each strand
};

}  // namespace pelage
