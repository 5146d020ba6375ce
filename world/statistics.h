// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "base/process_usage.h"
#include "geom/io/strand_file.h"
#include "render/frame/frame_result.h"
#include "world/compose.h"

namespace pelage {

/// Statistics of one run over all its frames, which `--stats` writes. No code updates them in the background:
/// each step of a run returns its counts, and the caller of the step adds them.
struct Statistics {
  ProcessUsage process = {};
  WorldCounts world = {};
  StrandRepairs repairs = {};  ///< counts of repairs of strands read from files
  FrameStatistics frames = {};
  std::map<std::string, double> stages_s = {};  ///< wall seconds by stage, except for stages in `frames`
  double first_pixel_s = 0;      ///< seconds from the start of the run until the first tile was done
  double samples_per_pixel = 0;  ///< mean over all pixels of all frames
  double noise = 0;              ///< max of frame_noise() over all frames; 0 if the film keeps no moments
  bool time_limited = false;     ///< whether any frame reached render.time_limit
  bool dual = false;             ///< light of many bounces is an estimate: `indirect: dual`
  double clamped_fraction = 0;   ///< fraction of the indirect light that render.clamp_indirect removed: max
                                 ///< over all frames

  /// Adds the result of a frame. `posed_s`: seconds from the start of the run to the start of this frame's
  /// render. `share`: weight of the frame in means, 1 / (number of frames of the run).
  void add(const FrameResult& result, double posed_s, double share);
};

}  // namespace pelage
