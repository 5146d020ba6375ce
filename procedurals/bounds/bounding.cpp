// SPDX-License-Identifier: Apache-2.0
#include "procedurals/bounds/bounding.h"

#include <optional>

#include "procedurals/bounds/measured_bounds.h"

namespace pelage {
namespace {

Box3f scaled(const Box3f& box, float factor) {
  if (box.isEmpty()) return box;
  const V3f middle = box.center(), half = 0.5f * factor * box.size();
  return {middle - half, middle + half};
}

/// Boxes that need no strands.
std::vector<ChunkBounds> stated_bounds(const BoundingOptions& options,
                                       std::span<const Procedural* const> chunks, const Job& job) {
  std::vector<ChunkBounds> bounds(chunks.size());
  job.workers.for_each(chunks.size(), 1, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end && !job.progress.cancelled(); ++i) {
      const Box3f box = chunks[i]->bound(bound_span(options.strategy));
      bounds[i].boxes = {options.strategy == BoundingStrategy::kUser ? scaled(box, options.factor) : box};
      job.progress.advance(1);
    }
  });
  return bounds;
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

std::vector<ChunkBounds> bound_chunks(const BoundingOptions& options,
                                      std::span<const Procedural* const> chunks, const Job& job,
                                      BoundingCounts* counts) {
  if (options.strategy == BoundingStrategy::kNone) return std::vector<ChunkBounds>(chunks.size());
  job.progress.begin("bound", static_cast<double>(chunks.size()));
  std::vector<ChunkBounds> bounds;
  BoundingCounts found;
  if (measures_strands(options.strategy)) {
    MeasuredBounds measured(options, chunks, [&](const std::string& line) { job.progress.warn(line); });
    measured.read(job);
    const std::optional<ContentStore::Lock> lock = measured.lock(job);
    measured.measure(job);
    found = measured.counts();
    bounds = std::move(measured).bounds();
  } else {
    bounds = stated_bounds(options, chunks, job);
    for (const ChunkBounds& chunk : bounds) found.area += area_of(chunk);
  }
  job.progress.end();
  if (counts) {
    counts->measured += found.measured;
    counts->remembered += found.remembered;
    counts->area += found.area;
  }
  return bounds;
}

}  // namespace pelage
