// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/strands.h"
#include "render/accel/embree_accel.h"

namespace pelage {

/// Control points of a batch of strands in the form that Embree reads, and the mapping from Embree's
/// primitives back to strands.
///
/// Unpinned B-splines and linear strands are read in place; pinned B-splines and Catmull-Rom strands need a
/// copy with a phantom point at each end.
///
/// Embree splits each flat segment into tessellation_rate straight pieces. The maximum rate is 16. Of the
/// camera rays that hit a ball of 100,000 strands, 5.9 % hit a different strand at rate 4 than at rate 16. At
/// rate 8, 1.2 % differ from rate 16; at rate 12, 0.4 %. Rates 4 and 8 cost the same (one AVX register); rate
/// 16 makes shadow rays 4 to 10 % slower. The default is therefore 8.
class EmbreeCurves {
 public:
  explicit EmbreeCurves(const AccelStrands& source);

  const Strands& strands() const { return *source_.strands; }
  uint32_t part() const { return source_.part; }
  bool opaque() const { return source_.opacity.empty(); }

  /// Returns x, y, z and radius of every control point at one motion key: four floats per point.
  const float* vertices(int key) const;
  size_t vertex_count() const { return vertex_count_; }
  /// Index of the first control point of each segment.
  std::span<const uint32_t> segments() const { return first_vertex_; }

  struct Place {
    uint32_t strand = 0;
    uint32_t segment = 0;
  };
  Place locate(uint32_t primitive) const;
  float opacity(Place place, float u) const;
  /// Prefetches the data of a strand that shading will read. Call this for every hit that may become the
  /// nearest, so that the rest of the traversal hides the latency.
  void fetch_ahead(uint32_t primitive) const;

  /// Bytes of heap memory that this object holds.
  size_t bytes() const;

 private:
  void copy_with_phantoms();

  AccelStrands source_;
  size_t vertex_count_ = 0;
  std::vector<float> copy_;                  // control points with phantom ends, or empty: read in place
  std::vector<uint32_t> first_vertex_;       // one per segment
  uint32_t segments_per_strand_ = 0;         // if all strands have the same number; otherwise 0
  uint32_t points_per_strand_ = 0;           // if all strands have the same number; otherwise 0
  std::vector<uint32_t> strand_of_segment_;  // empty if all strands have the same number of segments
  std::vector<uint32_t> first_segment_;  // by strand; empty if all strands have the same number of segments
};

}  // namespace pelage
