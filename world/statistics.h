// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "base/process_usage.h"
#include "geom/io/strand_file.h"
#include "render/frame/frame_result.h"
#include "world/compose.h"

namespace pelage {

/// Numbers of one run, as `--stats` writes them: the counts of every room, over all frames. A plain value:
/// the code that runs a step adds the counts that the step returns.
struct Statistics {
  ProcessUsage process = {};
  WorldCounts world = {};
  StrandRepairs repairs = {};  ///< repairs of strand files
  FrameStatistics frames = {};
  std::map<std::string, double> stages_s = {};  ///< wall seconds by stage, except those in `frames`
  double first_pixel_s = 0;  ///< seconds from the start of the run until the first tile of the first frame
                             ///< was done
  double samples_per_pixel = 0;  ///< mean over all pixels of all frames
  double noise = 0;              ///< frame_noise() of the noisiest frame; 0 if the film keeps no moments
  bool time_limited = false;     ///< some frame reached render.time_limit
  double clamped_fraction = 0;   ///< fraction of the indirect light that render.clamp_indirect removed: max
                                 ///< over all frames

  /// Adds a frame that began to render `posed_s` seconds after the start of the run. `share`: 1 / the
  /// number of frames of the run.
  void add(const FrameResult& result, double posed_s, double share);
};

}  // namespace pelage
