// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "base/job.h"
#include "render/frame/camera_samples.h"
#include "render/frame/coat_shell.h"
#include "render/frame/frame_shading.h"
#include "render/frame/frame_statistics.h"
#include "render/frame/visibility_table.h"
#include "render/light/direct_light.h"
#include "render/path/path_options.h"

namespace pelage {

/// What pilots take: rays, and memory in bytes.
struct PilotNeeds {
  int64_t rays = 0;           ///< max count
  int64_t tracing_bytes = 0;  ///< max memory while pilots are traced
  int64_t held_bytes = 0;     ///< max memory of the table afterwards
};

/// Learns the visibility of lights from pilot rays, before the picture is rendered.
///
/// Pilots are paths from the camera through pixels that a hash chooses over the whole picture. At each of
/// their first vertices, several points on lights are drawn, and a shadow ray is traced to each. Pilots use
/// random numbers of their own, so that what they learn is independent of the picture's shadow rays. The
/// table depends on the scene only: not on threads, memory, regions or samples so far.
class VisibilityPilots {
 public:
  /// Keeps references to `scene` and `accel`. `options`: those of the picture. Known balls are used: light
  /// that they block is not learned.
  VisibilityPilots(const FrameScene& scene, const Accel& accel, const PathOptions& options);

  /// Traces all pilots, and returns what they learned. Adds their rays to `statistics`. Throws Error
  /// (kMemory) if the table may not fit `render.memory`, and Error (kStopped) when the job is stopped.
  std::unique_ptr<const VisibilityTable> learn(const Job& job, FrameStatistics& statistics) const;
  /// Traces some pilots, and fits a shell to the coats of each skin with balls. As learn() otherwise.
  std::vector<CoatShell> fit_shells(const Job& job, FrameStatistics& statistics) const;
  /// Returns what learn() takes.
  static PilotNeeds needs_of_table(const FrameScene& scene);
  /// Returns what fit_shells() takes.
  static PilotNeeds needs_of_shells(const FrameScene& scene);

 private:
  struct PilotRay;
  struct Scratch;
  using PilotRays = std::vector<std::vector<PilotRay>>;  // by block of pilots

  static size_t count(const FrameScene& scene);
  static PilotNeeds needs_of_rays(const FrameScene& scene, size_t pilots);
  PilotRays trace(size_t begin, size_t end, const Job& job, std::vector<Scratch>& scratch) const;
  void follow(size_t pilot, Scratch& scratch, std::vector<PilotRay>& rays) const;
  static int64_t batch_bytes(const FrameScene& scene);
  static void add_costs(const std::vector<Scratch>& scratch, FrameStatistics& statistics);

  const FrameScene scene_;
  const Accel& accel_;
  FrameShading shading_;
  CameraSamples camera_;
  DirectLight direct_;
};

}  // namespace pelage
