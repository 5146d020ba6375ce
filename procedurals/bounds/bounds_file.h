// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "base/content_store.h"
#include "procedurals/bounds/chunk_bounds.h"
#include "procedurals/bounds/procedural.h"

namespace pelage {

// A side file contains the boxes of all chunks of one coat in one pose. It is an entry of kind "boxes" in the
// content store beside the groom's cache. It has four sections:
//   1. the index of each chunk's first box, and the total number of boxes: count + 1 numbers of 32 bits
//   2. the boxes: 6 floats each (min, max)
//   3. for each chunk, the grid of its cell bounds (9 floats: corner, motion, step) and their number (32
//   bits)
//   4. the groups of cell bounds of all chunks, only of the finest level (SegmentCellBounds::Group)

/// Raised whenever the same strands get different boxes, or the layout of the file changes.
/// tests/procedurals/stored_versions_test.cpp fails when boxes change and the version does not.
inline constexpr uint32_t kBoundsVersion = 2;

/// Reads the boxes of all chunks of the entry `record`, with `keys` keys each. Returns an empty list when the
/// entry is missing. A damaged or implausible entry causes one warning and counts as missing.
std::vector<ChunkBounds> read_bounds(const BoundsRecord& record, BoundSpan span, int keys,
                                     const WarningSink& warn);

/// Writes the boxes of all chunks to the entry `record`. Reports file system errors to `warn`.
void write_bounds(const BoundsRecord& record, BoundSpan span, int keys,
                  std::span<const ChunkBounds* const> bounds, const WarningSink& warn);

}  // namespace pelage
