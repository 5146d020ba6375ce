// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>

#include "cache/residency_counts.h"
#include "procedurals/bounds/chunk_bounds.h"
#include "render/accel/trace_counts.h"
#include "render/frame/ray_meter.h"
#include "render/frame/tile_costs.h"

namespace pelage {

/// CPU seconds of tracing the tiles of a frame, without the growth of chunks; over all threads.
struct RenderSeconds {
  double camera_rays = 0, shadow_rays = 0, indirect_rays = 0;
  double shading = 0;  ///< everything else: materials, choice of lights, film

  double total() const { return camera_rays + shadow_rays + indirect_rays + shading; }
  RenderSeconds& operator+=(const RenderSeconds& other);
};

/// Divides the CPU time of tiles, of which `growth_s` was spent on chunks. The times of rays are estimates:
/// if they exceed the rest, they are scaled down to it, so that the sum is always the CPU time less
/// `growth_s`.
RenderSeconds render_seconds(const TileCosts& tiles, double growth_s);

/// Counts of the reflection cache of `integrator: gather`, for one thread, one frame or several frames.
struct ReflectionStatistics {
  int64_t cells = 0;  ///< of all sizes
  int64_t paths = 0;  ///< that found a third surface and were added to the cells
  /// Slices of cells that were filled one after the other, in the frame with most; 1 if memory suffices.
  int64_t slices = 0;
  int64_t bytes = 0;    ///< of the cells while the picture is rendered, in the frame with most
  int64_t lookups = 0;  ///< paths that asked for the light of their third surface
  int64_t found = 0;    ///< lookups that were answered; the other paths continued

  ReflectionStatistics& operator+=(const ReflectionStatistics& other) {
    cells += other.cells;
    paths += other.paths;
    slices = std::max(slices, other.slices);
    bytes = std::max(bytes, other.bytes);
    lookups += other.lookups;
    found += other.found;
    return *this;
  }
};

/// Counts of `integrator: gather`, for one thread, one frame or several frames. A gather point is a position
/// on a strand or skin near which camera samples share light. It counts once per tile that sees it, and once
/// per pass over that tile. In a long frame, the first pass has one sample per pixel.
struct GatherPointStatistics {
  /// `samples`: camera samples that hit a strand or skin.
  int64_t count = 0, samples = 0;

  GatherPointStatistics& operator+=(const GatherPointStatistics& other) {
    count += other.count;
    samples += other.samples;
    return *this;
  }
};

/// Counts of the chunks that rays could hit, and of the strands that were grown for rays. Strands that were
/// grown only to measure their boxes do not count.
struct GrowthCounts {
  int64_t chunks = 0;   ///< count of chunks of coats and skins, grown or not
  int64_t strands = 0;  ///< count of strands grown; a strand counts each time it is grown
  BoundsArea area;      ///< total area of the boxes of all chunks of coats

  GrowthCounts& operator+=(const GrowthCounts& other) {
    chunks += other.chunks;
    strands += other.strands;
    area += other.area;
    return *this;
  }
};

/// Counts and times of rendering one frame, or of several frames one after the other.
struct FrameStatistics {
  GrowthCounts growth;
  ResidencyCounts residency;
  StoredReads reads;  ///< chunks that were read from render.bvh.file
  TraceCounts trace;
  RayStatistics rays;
  OcclusionCounts occlusion;
  RenderSeconds cpu_s;                     ///< CPU seconds of tiles; `residency` counts growth
  int64_t samples_rejected = 0;            ///< camera samples that were not finite; a bug if not 0
  std::map<std::string, double> stages_s;  ///< wall-clock seconds, by name of the stage
  GatherPointStatistics gather_points;
  ReflectionStatistics reflections;

  FrameStatistics& operator+=(const FrameStatistics& other);
};

}  // namespace pelage
