// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "cache/residency_counts.h"
#include "procedurals/bounds/growth_counts.h"
#include "render/accel/trace_counts.h"
#include "render/frame/gather_point_statistics.h"
#include "render/frame/occlusion_counts.h"
#include "render/frame/ray_statistics.h"
#include "render/frame/reflection_statistics.h"
#include "render/frame/render_seconds.h"

namespace pelage {

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
  GatherPointStatistics knots;
  ReflectionStatistics reflections;

  FrameStatistics& operator+=(const FrameStatistics& other);
};

}  // namespace pelage
