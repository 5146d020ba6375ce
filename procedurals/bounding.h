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
  float factor = 1;  ///< of kUser, about the centre of each box
  /// Parts are dropped as soon as a chunk is remembered: for who needs none, they are most of what is made.
  bool in_one_part = false;
};

/// During which time the boxes of a strategy hold what they hold, for skins too.
BoundSpan bound_span(BoundingStrategy strategy);
/// Whether it grows chunks to learn their boxes, which side files remember.
bool measures_strands(BoundingStrategy strategy);
/// ChunkBounds::keys of all chunks.
int bound_keys(BoundingStrategy strategy);

struct BoundingCounts {
  int64_t measured = 0;    ///< chunks that were grown to be measured: the first of two passes
  int64_t remembered = 0;  ///< chunks whose boxes were found in a side file
  BoundsArea area;         ///< of all chunks, in all parts that they had
};

/// What measuring the strands of a leaf holds: them, and what divides them, but not what growing them takes.
size_t measuring_bytes(const StrandCounts& counts);

/// The boxes of all chunks, which are leaves, in their order. What is measured is remembered beside the
/// caches of the grooms (Procedural::bounds_record); a damaged side file is reported as a warning and written
/// anew. The result is the same for any number of workers, measured or remembered. Strands that are grown to
/// be measured are charged to the chunks while they exist; they are few at a time and gone afterwards. kNone
/// gives no boxes: whoever grows everything knows better ones. Throws what growing throws. Leaves early when
/// the job is cancelled, with chunks of no box.
std::vector<ChunkBounds> bound_chunks(const BoundingOptions& options,
                                      std::span<const Procedural* const> chunks, const Job& job,
                                      BoundingCounts* counts = nullptr);

}  // namespace pelage
