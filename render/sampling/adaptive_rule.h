// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/sampling/adaptive_params.h"
#include "render/sampling/pixel_moments.h"

namespace pelage {

/// Half width of a 95 % confidence interval, in standard errors.
inline constexpr double kConfidence = 1.96;

/// Estimates for one pixel from the pilot, the samples that are taken first.
struct PilotPixel {
  float mean = 0, variance = 0;  ///< of the luminance of single samples
  bool hit = false;              ///< whether any camera ray hit a surface
  uint32_t samples = 0;          ///< count
};

/// Pilot of a whole frame; pixels row by row.
struct Pilot {
  int width = 0, height = 0;
  std::vector<PilotPixel> pixels;
};

// In the rule of pixels, pixels form a chessboard of two colours.

/// Decides which pixels need the whole pilot. `probe`: the first part of the pilot, which takes the same
/// count of samples in every pixel. Returns 0 for a pixel if no sample of its neighbours hits a surface and
/// all these samples are equal; otherwise 1. The neighbours are the other pixels of the same colour in the
/// surrounding 5 x 5 pixels: up to 12.
std::vector<uint8_t> needs_full_pilot(const Pilot& probe);

/// Returns the count of samples, including the pilot samples, that each pixel needs to meet the noise
/// budget. Counts are real numbers; they are neither rounded nor limited to `max`.
///
/// The count of a pixel follows from the luminances that pixels of the other colour have in the pilot.
/// Samples of different pixels are independent, so the count does not depend on the pixel's own luminances.
/// The plain mean of all samples of the pixel, including the pilot, is therefore unbiased, and no sample is
/// discarded. (If the count depended on the pixel's own pilot, this mean would be biased.)
///
/// The relative variance of a pixel is the mean variance of the 12 pixels of the other colour in its 5 x 5
/// neighbourhood, divided by the square of their mean luminance. Very dark neighbourhoods are treated as if
/// they were somewhat brighter. With `goal: frame`, counts are proportional to the square root of the
/// relative variance [Neyman34]: no smaller sum of counts reaches the required mean of variance / count. With
/// `goal: pixel`, counts are proportional to the relative variance itself. If the neighbours hit nothing and
/// do not vary, the count is 0. If they hit a surface but do not vary, their variance is unknown: the pixel
/// gets the mean count of the pixels of its own colour whose variance is known, or `max` if there are none.
///
/// Where brightness differs between neighbouring pixels, the mean of the neighbourhood hides dark pixels. The
/// remaining noise is then slightly above the budget; frame_noise() measures it.
std::vector<float> two_stage_counts(const Pilot& pilot, const AdaptiveParams& params, uint32_t max);

/// The rule of tiles, for samples that link the pixels of a tile: squares of `side` pixels, of which all
/// pixels get the same count.
///
/// Returns 0 for the pixels of a tile if no sample of the tile hits a surface and all its pixels have the
/// same mean; otherwise 1.
std::vector<uint8_t> tiles_need_full_pilot(const Pilot& probe, int side);

/// Returns counts of samples as two_stage_counts() does, for tiles. The relative variance of a tile is the
/// mean over its pixels of variance / squared mean of the surrounding 5 x 5 pixels. It comes from the tile's
/// own pilot, because other tiles show other things. So the mean of the samples is not free of bias: tiles
/// whose pilot has more variance by chance, such as a firefly, get more samples. But the variance is a mean
/// over the whole tile, so counts hardly depend on the pilot of a single pixel.
std::vector<float> two_stage_tile_counts(const Pilot& pilot, int side, const AdaptiveParams& params,
                                         uint32_t max);

/// Rounds a sample count to the nearest number of the form 4, 5, 6 or 7 times a power of two. Counts up to 4
/// are rounded up to an integer instead. The samples of a pixel are a sequence in which every aligned block
/// of 2^k samples is stratified; other counts would end with an incomplete large block.
uint32_t whole_blocks(double count);

/// Returns the noise of a frame: the root mean square, over all pixels whose samples vary, of half the width
/// of the 95 % confidence interval divided by the mean. Very dark pixels are treated as if they were somewhat
/// brighter. `goal: frame` limits this noise. Returns 0 if no pixel varies.
double frame_noise(std::span<const PixelMoments> pixels);

}  // namespace pelage
