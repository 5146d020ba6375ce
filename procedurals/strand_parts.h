// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/strands.h"
#include "procedurals/chunk_bounds.h"

namespace pelage {

/// Strands of a batch in groups of neighbours, because a batch is stored by priority and each of its prefixes
/// is all over the place.
struct StrandParts {
  std::vector<uint32_t> order;  ///< every strand once
  std::vector<uint32_t> first;  ///< part p is order[first[p]] .. order[first[p + 1] - 1]

  size_t count() const { return first.empty() ? 0 : first.size() - 1; }
  std::span<const uint32_t> part(size_t p) const {
    return std::span(order).subspan(first[p], first[p + 1] - first[p]);
  }
};

/// Divides a batch into parts of equal size, at most `most` strands each, halving at the median along the
/// longest axis again and again. A strand counts where its middle point is at the first motion key. No part
/// of an empty batch; never an empty one.
StrandParts divide_into_parts(const Strands& strands, size_t most = 256);

/// The exact box of every part. One key: over all motion keys. Two: at the first and the last, widened where
/// the box between them would not hold the part at a motion key between.
ChunkBounds exact_part_bounds(const Strands& strands, const StrandParts& parts, int keys);

/// Widens boxes at the two ends of the shutter so that the box between them, linear in time, holds `boxes`:
/// those at even times from end to end.
void interpolate_boxes(std::span<const Box3f> boxes, Box3f& open, Box3f& close);

}  // namespace pelage
