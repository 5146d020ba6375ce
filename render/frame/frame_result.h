// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/film/film.h"
#include "render/frame/frame_statistics.h"

namespace pelage {

/// A rendered frame.
struct FrameResult {
  Film film;
  uint32_t samples = 0;         ///< min number of paths per pixel
  double mean_samples = 0;      ///< mean number of paths per pixel
  double clamped_fraction = 0;  ///< fraction of the indirect light that render.clamp_indirect removed
  double noise = 0;             ///< frame_noise(); 0 if the film keeps no moments
  bool time_limited = false;    ///< render.time_limit determined the number of samples
  bool partial = false;         ///< cancelled: some pixels have fewer samples than requested, or none
  double first_tile_s = 0;      ///< seconds until the first tile had its first samples
  FrameStatistics statistics = {};
};

}  // namespace pelage
