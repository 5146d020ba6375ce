// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/content_store.h"
#include "base/job.h"
#include "procedurals/bounds/chunk_bounds.h"
#include "procedurals/bounds/procedural.h"

namespace pelage {

class MemoryLedger;

struct BoundingOptions {
  BoundingStrategy strategy = BoundingStrategy::kExact;
  float factor = 1;  ///< factor of kUser by which boxes are scaled about their centres
  /// Whether to return one box per chunk instead of the boxes of its parts. This saves memory, because the
  /// boxes of parts are most of the data. Side files contain the parts in any case.
  bool in_one_part = false;
};

/// Returns the time span for which the boxes of a strategy are valid, both of fur and of skins.
BoundSpan bound_span(BoundingStrategy strategy);
/// Returns whether the strategy grows each chunk to measure its boxes. Measured boxes are stored in side
/// files.
bool measures_strands(BoundingStrategy strategy);
/// Returns ChunkBounds::keys of all chunks for this strategy: 2 for kLinear, else 1.
int bound_keys(BoundingStrategy strategy);

struct BoundingCounts {
  int64_t measured = 0;    ///< count of chunks that were grown to measure their boxes
  int64_t remembered = 0;  ///< count of chunks whose boxes were read from a side file
  BoundsArea area;         ///< total area of the boxes of all chunks and parts
};

/// Returns the memory in bytes for measuring the strands of a leaf: the strands and their division into
/// parts. Does not include temporary memory for growing the strands.
size_t measuring_bytes(const StrandCounts& counts);

/// Returns the boxes of all chunks, in the order of `chunks`. All chunks must be leaves.
///
/// Measured boxes are read from and stored in side files, which are beside the caches of the grooms
/// (Procedural::bounds_record()). A damaged side file causes a warning and is replaced. The result does not
/// depend on the number of workers, nor on whether boxes are measured or read. At most one chunk per worker
/// is grown at a time. Its strands are charged to MemoryTag::kChunks while they exist.
///
/// For kNone, returns chunks without boxes, because the caller then grows all chunks and measures their boxes
/// itself. Adds to `counts` if it is not null. Passes on the exceptions of growing. Returns early when the
/// job is cancelled; chunks that were not measured then have no boxes.
std::vector<ChunkBounds> bound_chunks(const BoundingOptions& options,
                                      std::span<const Procedural* const> chunks, const Job& job,
                                      BoundingCounts* counts = nullptr);

}  // namespace pelage
