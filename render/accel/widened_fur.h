// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/accel/beam.h"
#include "render/accel/fur/fur_leaf.h"
#include "render/accel/fur/fur_tree.h"
#include "render/accel/min_width.h"
#include "render/accel/packed_strands.h"
#include "render/accel/primitive_sink.h"

namespace pelage {

/// The strands of a fur chunk as the camera sees them, with a min width. The radii of each segment are the
/// larger ones of its own and of the min radius at its first point. Strands that level of detail has widened
/// keep their width. Thread safety: const members from any thread.
class WidenedFur {
 public:
  WidenedFur(const MinWidth& min, const PackedStrands& strands);

  /// visit_segments() with the widened radii.
  void visit(const FurTreeView& tree, const PackedStrands& strands, const Beam& beam,
             PrimitiveSink& sink) const;

  /// A segment of one strand at all motion keys, in grid units.
  struct Segment {
    std::vector<SnappedSegment> keys;
    float min_radius = 0;

    /// Returns the true radius divided by the widened radius, at a parameter in [0, 1].
    float share(float u) const;
    /// Stores the widened segment as a wide block. Returns the first byte.
    const std::byte* write(uint32_t number, std::vector<Four>& memory) const;
  };
  /// Returns a segment from a leaf of the tree. `strand`: its strand.
  Segment segment(const FurTreeView& tree, const std::byte* block, bool wide, size_t lane,
                  uint32_t strand) const;

  /// Memory in use, including this object.
  size_t bytes() const { return bytes_bound(widened_before_.size()); }
  static size_t bytes_bound(size_t strands) { return sizeof(WidenedFur) + strands / 8 + sizeof(uint64_t); }

 private:
  class Sink;

  /// The min radius of a segment with this first point. Both are in grid units.
  float min_radius(const FurTreeView& tree, const V3f& first, uint32_t strand) const;

  MinWidth min_;
  std::vector<bool> widened_before_;  // by strand: whether level of detail has widened it; empty: none
};

}  // namespace pelage
