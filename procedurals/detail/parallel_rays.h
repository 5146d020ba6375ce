// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"

namespace pelage {

/// A short straight piece of a strand.
struct StrandPiece {
  V3f begin{0}, end{0};
  float begin_radius = 0, end_radius = 0;
  uint32_t strand = 0;                     ///< any number by which the caller tells strands apart
  bool is_first = false, is_last = false;  ///< of the strand, which has flat ends; other ends are round
};

/// Rays of one direction, sorted by where they cross a plane, to be tested against many strands in one pass.
class ParallelRays {
 public:
  /// `direction`: unit. The ray at index i starts at origins[i].
  ParallelRays(const V3f& direction, std::span<const V3f> origins);

  size_t size() const { return rays_.size(); }
  /// Bytes of memory of this object.
  size_t bytes() const {
    return sizeof(*this) + rays_.capacity() * sizeof(Ray) + first_.capacity() * sizeof(uint32_t);
  }

  /// Where a ray passes a piece of a strand.
  struct Pass {
    uint32_t ray;    ///< index of the ray
    float distance;  ///< along the ray; negative behind its origin
    float across;    ///< distance between the ray and the piece, in radii of the piece
  };
  /// Appends to `passes` the rays that pass the piece at less than `widen` times its radius.
  void meet(const StrandPiece& piece, float widen, std::vector<Pass>& passes) const;

 private:
  struct Flat {
    float x, y, z;  // across the direction, and along it
  };
  struct Ray {
    Flat origin;
    uint32_t index;
  };
  Flat flat(const V3f& p) const { return {p.dot(x_), p.dot(y_), p.dot(direction_)}; }
  uint32_t column(float x) const;
  uint32_t row(float y) const;

  V3f direction_, x_, y_;
  float left_ = 0, bottom_ = 0, per_unit_ = 0;
  uint32_t columns_ = 1, rows_ = 1;
  std::vector<Ray> rays_;        // by cell
  std::vector<uint32_t> first_;  // by cell, and the end
};

}  // namespace pelage
