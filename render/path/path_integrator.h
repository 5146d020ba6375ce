// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/ledger.h"
#include "base/progress.h"
#include "base/statistics.h"
#include "render/film/film.h"
#include "render/path/path_tracer.h"
#include "render/render_scene.h"

namespace pelage {

class Workers;

/// What a render leaves.
struct FrameResult {
  Film film;
  uint32_t samples = 0;     ///< paths that every pixel has got
  bool partial = false;     ///< cancelled: some pixels have fewer than asked for, perhaps none
  double first_tile_s = 0;  ///< seconds until the first tile had its first samples
};

/// Renders one frame: bounds all chunks, and traces paths in passes of 1, 1, 2, 4, 8 ... samples over the
/// whole image, so that a picture cancelled at any time is a valid one of fewer samples. Where the memory
/// limit does not hold all chunks, there is one pass of all samples.
///
/// The same scene gives the same film for any number of threads. Adds rays, strands, rejected samples and
/// stage times to `statistics`. Throws Error; nothing is thrown out of the render loops.
FrameResult render_frame(const RenderScene& scene, const Workers& workers, Progress& progress,
                         MemoryLedger& ledger, Statistics& statistics, const PathOptions& options = {});

}  // namespace pelage
