// SPDX-License-Identifier: Apache-2.0
#include "procedurals/bounding.h"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "base/check.h"
#include "base/ledger.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "procedurals/bounds_file.h"
#include "procedurals/segment_parts.h"

namespace pelage {
namespace {

/// Chunks whose boxes are remembered in one file: all that the file is about.
struct Family {
  BoundsRecord record;
  std::vector<size_t> chunks;  // by index in the file; SIZE_MAX where a chunk is not among those bounded
  bool known = false;          // read from the file

  bool is_complete() const { return std::find(chunks.begin(), chunks.end(), SIZE_MAX) == chunks.end(); }
};

std::vector<Family> find_families(std::span<const Procedural* const> chunks) {
  std::vector<Family> families;
  for (size_t i = 0; i < chunks.size(); ++i) {
    const std::optional<BoundsRecord> record = chunks[i]->bounds_record();
    if (!record) continue;
    // Leaves of a coat come one after the other.
    if (families.empty() || families.back().record.key != record->key ||
        families.back().chunks[record->index] != SIZE_MAX) {
      families.push_back({*record, std::vector<size_t>(record->count, SIZE_MAX)});
    }
    families.back().chunks[record->index] = i;
  }
  return families;
}

Box3f scaled(const Box3f& box, float factor) {
  if (box.isEmpty()) return box;
  const V3f middle = box.center(), half = 0.5f * factor * box.size();
  return {middle - half, middle + half};
}

double surface(const Box3f& box) {
  if (box.isEmpty()) return 0;
  const V3f d = box.size();
  return 2 * (double(d.x) * d.y + double(d.y) * d.z + double(d.z) * d.x);
}

/// Boxes that need no strand.
std::vector<ChunkBounds> stated_bounds(const BoundingOptions& options,
                                       std::span<const Procedural* const> chunks, const Workers& workers,
                                       Progress& progress) {
  std::vector<ChunkBounds> bounds(chunks.size());
  workers.for_each(chunks.size(), 1, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end && !progress.cancelled(); ++i) {
      const Box3f box = chunks[i]->bound(bound_span(options.strategy));
      bounds[i].boxes = {options.strategy == BoundingStrategy::kUser ? scaled(box, options.factor) : box};
      progress.advance(1);
    }
  });
  return bounds;
}

/// Bytes of the strands of a chunk, and of what divides them, while it is measured.
int64_t growth_bytes(const Procedural& chunk) {
  const StrandCounts counts = chunk.counts();
  return static_cast<int64_t>((counts.points * counts.motion_keys * 4 + counts.attribute_floats) *
                                  sizeof(float) +
                              SegmentParts::bytes_bound(counts.segments, counts.motion_keys));
}

}  // namespace

BoundSpan bound_span(BoundingStrategy strategy) {
  return strategy == BoundingStrategy::kExactShutter || strategy == BoundingStrategy::kLinear
             ? BoundSpan::kShutter
             : BoundSpan::kFrame;
}

bool measures_strands(BoundingStrategy strategy) {
  return strategy == BoundingStrategy::kExact || strategy == BoundingStrategy::kExactShutter ||
         strategy == BoundingStrategy::kLinear;
}

int bound_keys(BoundingStrategy strategy) { return strategy == BoundingStrategy::kLinear ? 2 : 1; }

BoundsArea bounds_area(std::span<const ChunkBounds> bounds) {
  BoundsArea sum;
  for (const ChunkBounds& chunk : bounds) {
    for (int key = 0; key < chunk.keys; ++key) {
      Box3f whole;
      for (size_t part = 0; part < chunk.part_count(); ++part) {
        whole.extendBy(chunk.box(part, key));
        sum.parts += surface(chunk.box(part, key)) / chunk.keys;
      }
      sum.chunks += surface(whole) / chunk.keys;
    }
  }
  return sum;
}

std::vector<ChunkBounds> bound_chunks(const BoundingOptions& options,
                                      std::span<const Procedural* const> chunks, const Workers& workers,
                                      Progress& progress, MemoryLedger& ledger, const WarningSink& warn,
                                      BoundingCounts* counts) {
  if (options.strategy == BoundingStrategy::kNone) return std::vector<ChunkBounds>(chunks.size());
  progress.begin("bound", static_cast<double>(chunks.size()));
  if (!measures_strands(options.strategy)) {
    std::vector<ChunkBounds> bounds = stated_bounds(options, chunks, workers, progress);
    progress.end();
    return bounds;
  }

  const BoundSpan span = bound_span(options.strategy);
  const int keys = bound_keys(options.strategy);
  std::mutex warning;  // a sink is called by one thread at a time
  const WarningSink warn_alone = [&](const std::string& line) {
    const std::lock_guard lock(warning);
    warn(line);
  };

  std::vector<ChunkBounds> bounds(chunks.size());
  for (ChunkBounds& chunk : bounds) chunk.keys = keys;
  std::vector<char> known(chunks.size(), false);
  std::vector<Family> families = find_families(chunks);
  workers.for_each(families.size(), 1, [&](WorkRange range) {
    for (size_t f = range.begin; f < range.end && !progress.cancelled(); ++f) {
      Family& family = families[f];
      std::vector<ChunkBounds> read = read_bounds(family.record, span, keys, warn_alone);
      family.known = !read.empty();
      for (size_t i = 0; i < read.size(); ++i) {
        const size_t chunk = family.chunks[i];
        if (chunk == SIZE_MAX) continue;
        bounds[chunk] = std::move(read[i]);
        known[chunk] = true;
        progress.advance(1);
      }
    }
  });

  std::vector<size_t> unknown;
  for (size_t i = 0; i < chunks.size(); ++i) {
    if (!known[i]) unknown.push_back(i);
  }
  workers.for_each(unknown.size(), 1, [&](WorkRange range) {
    for (size_t u = range.begin; u < range.end && !progress.cancelled(); ++u) {
      const Procedural& chunk = *chunks[unknown[u]];
      const MemoryCharge passing(ledger, MemoryTag::kChunks, growth_bytes(chunk));
      bounds[unknown[u]] = chunk.exact_bounds(span, keys);
      progress.advance(1);
    }
  });
  if (!progress.cancelled()) {
    workers.for_each(families.size(), 1, [&](WorkRange range) {
      for (size_t f = range.begin; f < range.end; ++f) {
        const Family& family = families[f];
        if (family.known || !family.is_complete()) continue;
        std::vector<ChunkBounds> all;
        for (size_t chunk : family.chunks) all.push_back(bounds[chunk]);
        write_bounds(family.record, span, keys, all, warn_alone);
      }
    });
  }
  progress.end();
  if (counts) {
    counts->measured += static_cast<int64_t>(unknown.size());
    counts->remembered += static_cast<int64_t>(chunks.size() - unknown.size());
  }
  return bounds;
}

}  // namespace pelage
