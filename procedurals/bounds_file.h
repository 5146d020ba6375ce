// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "base/content_store.h"
#include "procedurals/chunk_bounds.h"
#include "procedurals/procedural.h"

namespace pelage {

// The side file with the boxes of all chunks of one coat in one pose: an entry of kind "boxes" in the content
// store beside the groom's cache. It has four sections: the index of each chunk's first box (count + 1
// numbers of 32 bits); the boxes (6 floats each: min, max); for each chunk the grid of its fine boxes (9
// floats: corner, motion, step) and the number of fine boxes (32 bits); the groups of the finest level of
// fine boxes.

/// Reads the boxes of all chunks of the record, with `keys` keys each; empty when the entry is missing. A
/// damaged or implausible entry counts as missing, with one warning.
std::vector<ChunkBounds> read_bounds(const BoundsRecord& record, BoundSpan span, int keys,
                                     const WarningSink& warn);

/// Writes an entry; reports file system errors to `warn`.
void write_bounds(const BoundsRecord& record, BoundSpan span, int keys,
                  std::span<const ChunkBounds* const> bounds, const WarningSink& warn);

}  // namespace pelage
