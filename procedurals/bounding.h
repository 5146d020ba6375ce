// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/content_store.h"
#include "base/job.h"
#include "procedurals/chunk_bounds.h"
#include "procedurals/procedural.h"

namespace pelage {

class MemoryLedger;

struct BoundingOptions {
  BoundingStrategy strategy = BoundingStrategy::kExact;
  float factor = 1;  ///< scale of the boxes of kUser about their centres
  /// Drops the parts of a chunk as soon as the chunk has been recorded, for callers that do not need parts.
  /// Parts are most of the data.
  bool in_one_part = false;
};

/// Time span for which the boxes of a strategy are valid, including boxes of skins.
BoundSpan bound_span(BoundingStrategy strategy);
/// Whether the strategy grows chunks to measure their boxes, which are stored in side files.
bool measures_strands(BoundingStrategy strategy);
/// ChunkBounds::keys of all chunks.
int bound_keys(BoundingStrategy strategy);

struct BoundingCounts {
  int64_t measured = 0;    ///< chunks grown to be measured: the first of two passes
  int64_t remembered = 0;  ///< chunks whose boxes were read from a side file
  BoundsArea area;         ///< area of the boxes of all chunks and parts
};

/// Memory for measuring the strands of a leaf: the strands and their division into parts, without the memory
/// for growing them.
size_t measuring_bytes(const StrandCounts& counts);

/// Returns the boxes of all chunks, in the order of `chunks`. All chunks must be leaves. Measured boxes are
/// stored beside the caches of the grooms (Procedural::bounds_record); a damaged side file causes a warning
/// and is rewritten. The result is the same for any number of workers, whether boxes are measured or read. A
/// few chunks at a time are grown to be measured; their strands are charged to MemoryTag::kChunks while they
/// exist. kNone returns no boxes: code that grows everything measures better boxes. Passes on errors of
/// growth. Returns early when the job is cancelled; unmeasured chunks then have no box.
std::vector<ChunkBounds> bound_chunks(const BoundingOptions& options,
                                      std::span<const Procedural* const> chunks, const Job& job,
                                      BoundingCounts* counts = nullptr);

}  // namespace pelage
