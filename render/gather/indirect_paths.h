// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "base/job.h"
#include "render/frame/frame_statistics.h"
#include "render/gather/gather_point_order.h"
#include "render/gather/path_sharing.h"
#include "render/gather/tile_samples.h"
#include "render/path/path_walk.h"
#include "render/reflection/reflection_cache.h"

namespace pelage {

/// Traces indirect paths from some of the visible points of a tile. Roulette chooses these points. Thread
/// safety: const members may be called from any thread, each with its own scratch.
class IndirectPaths {
 public:
  /// Keeps references to its arguments, except `options`. `cache`: ends paths at their third surface; may
  /// be empty.
  IndirectPaths(const FrameScene& scene, const Accel& accel, const FrameShading& shading,
                const CameraSamples& camera, const PathOptions& options,
                const std::optional<ReflectionCache>& cache)
      : scene_(scene),
        camera_(camera),
        cache_(cache),
        options_(options),
        walk_(scene, accel, shading, options) {}

  struct Scratch {
    DirectLightScratch direct;
    GatherPointOrder order;  // visible points, sorted by gather point
    ReflectionStatistics reflections;
    std::vector<Rgb> arriving;  // radiance that arrives at the visible point along a path, by light
    struct Traced {
      uint32_t point = 0;  // index of the visible point
      float factor = 0;    // count of visible points that the path represents
    };
    std::vector<Traced> traced;
    std::vector<Rgb> arrived;  // `arriving` of each traced path
  };

  /// Traces the paths, learns from them how indirect light falls off in coats, and adds their light to
  /// `light`, relative to that. Also adds the weights of all visible points to `light`. Returns false when
  /// `job` was cancelled.
  bool trace(const TileSamples& samples, const Job& job, Scratch& scratch, SampleScratch& thread,
             PathSharing& light) const;

 private:
  class ArrivingLight;
  bool trace_paths(const TileSamples& samples, const Job& job, Scratch& scratch, SampleScratch& thread,
                   DepthProfile& profile) const;
  void follow(const TileSamples& samples, const VisiblePoint& point, float factor, Scratch& scratch,
              SampleScratch& thread) const;

  const FrameScene scene_;
  const CameraSamples& camera_;
  const std::optional<ReflectionCache>& cache_;
  const PathOptions options_;
  PathWalk<ArrivingLight> walk_;
};

}  // namespace pelage
