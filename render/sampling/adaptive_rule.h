// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/sampling/adaptive_params.h"
#include "render/sampling/pixel_moments.h"

namespace pelage {

/// Standard errors in half of a 95 % confidence interval.
inline constexpr double kConfidence = 1.96;

/// Whether the rule of the seed would stop here: 1.96 sigma / sqrt(n) <= noise * mean. Where samples that
/// are rare and bright make the mean, a pixel is likely to stop before it met one: as the mean and the time
/// of stopping depend on the same samples, what stops is too dark on average.
inline bool looks_converged(const PixelMoments& pixel, double noise) {
  return kConfidence * pixel.error() <= noise * pixel.mean;
}

/// What a pilot found out about one pixel.
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

/// Which pixels should have the whole pilot, by a first part of it (as many samples for every pixel): 0 where
/// all samples of the neighbours met nothing and are alike, 1 elsewhere. Pixels are coloured like a chess
/// board; neighbours are the 12 others of the same colour in the 5 x 5 pixels about one.
std::vector<uint8_t> needs_full_pilot(const Pilot& probe);

/// The number of samples, those of the pilot included, that each pixel should have to keep the noise budget:
/// a real number, not limited from below or above except that `max` stands where the pilot knows nothing.
///
/// The counts of one colour are a function of the pilot of the other colour alone, whose length is one of
/// that other colour's probes. Samples of different pixels are independent, so a pixel's count is independent
/// of all its samples, and the plain mean of all of them, pilot included, is unbiased: no sample is thrown
/// away. (A count that depends on the pixel's own pilot makes any mean of both stages with weights by number
/// biased.)
///
/// Relative variance at a pixel is the mean variance over the 12 pixels of the other colour in its 5 x 5
/// neighbourhood over their squared mean. For the frame as a whole, counts go with its root [Neyman34], which
/// keeps the mean of variance / count with the least sum of counts; for each pixel, with the variance. Where
/// brightness changes from pixel to pixel the neighbourhood's mean hides dark pixels, and the noise that is
/// left is somewhat above the budget: frame_noise() of the outcome says what it is.
std::vector<float> two_stage_counts(const Pilot& pilot, const AdaptiveParams& params, uint32_t max);

/// The nearest number of the form 4, 5, 6, 7 times a power of two: a pixel's samples are a sequence whose
/// aligned blocks of 2^k are stratified, and a number in between leaves a block torn. Up to 4, the next whole
/// number.
uint32_t whole_blocks(double count);

/// Root mean square over the pixels that vary of the half width of the 95 % confidence interval over the
/// mean, as `goal: frame` counts it: what the noise budget was kept to.
double frame_noise(std::span<const PixelMoments> pixels);

}  // namespace pelage
