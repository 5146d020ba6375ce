// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "groom/follicles/follicle_candidates.h"

namespace pelage {

/// A spatial hash grid of follicles, for progressive_order(). There is one grid per octave: follicles whose
/// spacings differ by more than a factor of two are in different grids. The cells of each grid suit the
/// spacings of its follicles, so a search never visits many small cells.
class OctaveGrid {
 public:
  /// `max`: approximate max number of follicles.
  OctaveGrid(float smallest_spacing, size_t max) : smallest_(smallest_spacing) { items_.reserve(max); }
  /// Returns the memory of a grid of at most `max` follicles after rebuild(expected, ...).
  static size_t bytes(size_t max, size_t expected) {
    return max * sizeof(Item) + head_count(expected) * sizeof(uint32_t);
  }

  /// Removes and inserts all follicles again, so that nearest() is fast for radii up to `radius` and for
  /// about `expected` follicles.
  void rebuild(size_t expected, float radius);
  void insert(const FollicleCandidate& follicle);
  /// Number of follicles.
  uint32_t size() const { return static_cast<uint32_t>(items_.size()); }

  /// Returns the distance from a candidate to the nearest follicle, divided by the smaller of their spacings.
  /// Returns `radius` if there is none within `radius`. Ignores follicles whose normals differ by more than
  /// 60 degrees from the candidate's normal. Stops at the first follicle that is much nearer than `radius`,
  /// even if another follicle may be nearer still. Ignores the first `skipped` follicles. Thread safe while
  /// no other thread calls insert() or rebuild().
  float nearest(const FollicleCandidate& candidate, float radius, uint32_t skipped = 0) const;

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
  /// `best` or the smaller distance to a follicle of the list that begins with `item`, up to follicle
  /// `skipped`.
  float nearest_in(uint32_t item, uint32_t skipped, const FollicleCandidate& candidate, const V3f& normal,
                   float best) const;
  int octave_of(float spacing) const;
  float inverse_cell(int octave) const { return 1.0f / (cell_ * static_cast<float>(uint64_t(1) << octave)); }
  size_t row(int32_t x, int32_t y, int32_t z, int octave) const;

  float smallest_;
  float cell_ = 1;
  unsigned octaves_ = 0;  // bit k is set if octave k holds follicles
  // First item of the list of each cell, in which later follicles precede earlier ones; the entries of 16
  // cells in a row along x are adjacent.
  std::vector<uint32_t> heads_;
  std::vector<Item> items_;
};

}  // namespace pelage
