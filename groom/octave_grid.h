// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "groom/follicle_candidates.h"

namespace pelage {

/// Follicles in a spatial hash grid, for progressive_order(). Follicles whose spacings differ by more than a
/// factor of two are kept in separate grids (octaves), so that a search never visits many small cells.
class OctaveGrid {
 public:
  /// For at most about `max` follicles.
  OctaveGrid(float smallest_spacing, size_t max) : smallest_(smallest_spacing) { items_.reserve(max); }
  /// Memory of a grid of at most `max` follicles after rebuild() has made room for `expected`.
  static size_t bytes(size_t max, size_t expected) {
    return max * sizeof(Item) + head_count(expected) * sizeof(uint32_t);
  }

  /// Reinserts everything for searches at radii up to `radius`, with room for about `expected` follicles.
  void rebuild(size_t expected, float radius);
  void insert(const FollicleCandidate& follicle);

  /// Distance from a candidate to the nearest follicle, in units of the smaller of the two spacings; at most
  /// `radius`. Ignores follicles whose normals differ by more than 60 degrees from the candidate's normal.
  /// The search stops at a follicle that is much nearer than `radius`, even if another follicle is nearer
  /// still.
  float nearest(const FollicleCandidate& candidate, float radius) const;

 private:
  static constexpr uint32_t kNone = 0xffffffffu;
  struct Item {
    float x, y, z;
    uint32_t normal;
    float spacing;
    uint32_t next;
  };

  static size_t head_count(size_t expected) { return std::max<size_t>(std::bit_ceil(2 * expected), 64); }
  void link(uint32_t item);
  float nearest_in(uint32_t item, const FollicleCandidate& candidate, const V3f& normal, float best) const;
  int octave_of(float spacing) const;
  float inverse_cell(int octave) const { return 1.0f / (cell_ * static_cast<float>(uint64_t(1) << octave)); }
  size_t row(int32_t x, int32_t y, int32_t z, int octave) const;

  float smallest_;
  float cell_ = 1;
  unsigned octaves_ = 0;         // bit k: octave k holds follicles
  std::vector<uint32_t> heads_;  // of lists; the cells of a row of 16 along x are adjacent
  std::vector<Item> items_;
};

}  // namespace pelage
