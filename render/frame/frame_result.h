// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/film/film.h"
#include "render/frame/frame_statistics.h"

namespace pelage {

/// A rendered frame.
struct FrameResult {
  Film film;
  uint32_t samples = 0;         ///< paths traced for every pixel, at least
  double mean_samples = 0;      ///< paths of all pixels over the number of pixels
  double clamped_fraction = 0;  ///< of the indirect light, by render.clamp_indirect
  double noise = 0;             ///< frame_noise(); 0 where the film keeps no moments
  bool time_limited = false;    ///< render.time_limit decided how many samples there are
  bool partial = false;         ///< cancelled: some pixels have fewer than asked for, perhaps none
  double first_tile_s = 0;      ///< seconds until the first tile had its first samples
  FrameStatistics statistics = {};
};

}  // namespace pelage
