// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/job.h"
#include "base/statistics.h"
#include "render/film/film.h"
#include "render/path/path_tracer.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// What a render leaves.
struct FrameResult {
  Film film;
  uint32_t samples = 0;         ///< paths that every pixel has got
  double mean_samples = 0;      ///< paths of all pixels over the number of pixels
  double clamped_fraction = 0;  ///< of the indirect light, by render.clamp_indirect
  double noise = 0;             ///< frame_noise(); 0 where the film keeps no moments
  bool time_limited = false;    ///< render.time_limit decided how many samples there are
  bool partial = false;         ///< cancelled: some pixels have fewer than asked for, perhaps none
  double first_tile_s = 0;      ///< seconds until the first tile had its first samples
};

/// Renders one frame: bounds all chunks, and traces paths in passes over the whole image (SampleSchedule), so
/// that a picture cancelled at any time is a valid one of fewer samples.
///
/// The same scene gives the same film for any number of threads, unless the time limit is met. Adds rays,
/// strands, rejected samples and stage times to `statistics`. Throws Error; nothing is thrown out of the
/// render loops.
FrameResult render_frame(const RenderScene& scene, const Job& job, Statistics& statistics,
                         const PathOptions& options = {});

}  // namespace pelage
