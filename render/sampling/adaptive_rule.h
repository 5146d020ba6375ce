// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/sampling/adaptive_params.h"
#include "render/sampling/pixel_moments.h"

namespace pelage {

/// Half of a 95 % confidence interval, in standard errors.
inline constexpr double kConfidence = 1.96;

/// Whether `rule: seed` would stop sampling this pixel: 1.96 sigma / sqrt(n) <= noise * mean. Where rare
/// bright samples dominate the mean, a pixel is likely to stop before it receives a bright sample. Because
/// the mean and the stopping time depend on the same samples, stopped pixels are too dark on average.
inline bool looks_converged(const PixelMoments& pixel, double noise) {
  return kConfidence * pixel.error() <= noise * pixel.mean;
}

/// Pilot estimate of one pixel.
struct PilotPixel {
  float mean = 0, variance = 0;  ///< of the luminance of one sample
  bool hit = false;              ///< whether any camera ray met a surface
  uint32_t samples = 0;
};

/// Pilot of a whole frame, row by row.
struct Pilot {
  int width = 0, height = 0;
  std::vector<PilotPixel> pixels;
};

/// Decides which pixels need the whole pilot, given its first part (the same number of samples for every
/// pixel). Returns 0 for a pixel if all samples of its neighbours hit nothing and are equal, otherwise 1.
/// Pixels form a chessboard of two colours; neighbours are the 12 other pixels of the same colour in the
/// surrounding 5 x 5 pixels.
std::vector<uint8_t> needs_full_pilot(const Pilot& probe);

/// The number of samples, including those of the pilot, that each pixel needs to meet the noise budget: a
/// real number without limits, except that pixels without information from the pilot get `max`.
///
/// The counts of one colour depend on the pilot of the other colour only. Samples of different pixels are
/// independent, so a pixel's count does not depend on the pixel's own samples. The plain mean of these
/// samples, including the pilot, is therefore unbiased: no sample is discarded. (If the count depended on the
/// pixel's own pilot, the plain mean of both stages would be biased.)
///
/// The relative variance of a pixel is the mean variance over the 12 pixels of the other colour in its 5 x 5
/// neighbourhood, divided by the square of their mean. With `goal: frame`, counts are proportional to the
/// square root of this variance [Neyman34]: no smaller sum of counts reaches the required mean of variance /
/// count. With `goal: pixel`, counts are proportional to the variance itself. Where brightness varies from
/// pixel to pixel, the neighbourhood's mean hides dark pixels, and the remaining noise is slightly above the
/// budget: frame_noise() reports it.
std::vector<float> two_stage_counts(const Pilot& pilot, const AdaptiveParams& params, uint32_t max);

/// The nearest number of the form 4, 5, 6, 7 times a power of two. A pixel's samples are a sequence in which
/// every aligned block of 2^k samples is stratified. Other numbers would leave a block incomplete. Counts up
/// to 4 are rounded up to an integer.
uint32_t whole_blocks(double count);

/// Half width of the 95 % confidence interval divided by the mean, as root mean square over the pixels that
/// vary. `goal: frame` limits this number.
double frame_noise(std::span<const PixelMoments> pixels);

}  // namespace pelage
