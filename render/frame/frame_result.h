// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/film/film.h"
#include "render/frame/frame_statistics.h"
#include "render/frame/frame_window.h"

namespace pelage {

/// A rendered frame.
struct FrameResult {
  Film film;                ///< pixel (x, y) of the film is pixel (window.film.x0 + x, window.film.y0 + y)
  FrameWindow window = {};  ///< the part of the picture that was rendered
  uint32_t samples = 0;     ///< min sample count over the traced pixels
  double mean_samples = 0;  ///< mean sample count over the traced pixels
  bool dual = false;        ///< light of many bounces is an estimate: `indirect: dual`
  double clamped_fraction = 0;  ///< fraction of the indirect light that render.clamp_indirect removed
  double noise = 0;             ///< frame_noise(); 0 if the film stores no moments
  bool time_limited = false;    ///< render.time_limit determined the number of samples
  bool partial = false;         ///< cancelled: some pixels have fewer samples than requested, or none
  double first_tile_s = 0;      ///< seconds from the start until the first tile had samples
  FrameStatistics statistics = {};
};

}  // namespace pelage
