// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/vector.h"
#include "render/film/pixel_filter.h"

namespace pelage {

/// Weighted sums of the channels of a picture, per pixel.
///
/// Without a splat filter, sample positions come from the pixel filter. A sample then counts for its
/// own pixel alone, with weight 1. With a splat filter, a sample lies anywhere in its pixel. It counts for
/// every pixel whose filter covers it, weighted by the value of that filter. With the Blackman-Harris filter,
/// this halves the variance for the same number of samples, but the noise of neighbouring pixels is
/// correlated.
///
/// Each tile has a buffer, which extends beyond the tile by the reach of the splat filter. A sample is added
/// only to the buffer of its own tile. The value of a pixel is the sum over the buffers that contain it (at
/// most four), always in the same order. The result therefore does not depend on which tiles are traced at
/// the same time.
///
/// Thread safety: threads may write different tiles at the same time. Without a splat filter, they may also
/// write different pixels of one tile.
class FilmSums {
 public:
  /// Side of a tile in pixels.
  static constexpr int kTileSide = 16;

  FilmSums(int width, int height, size_t channels, std::optional<PixelFilter> splat);
  /// Returns the memory of the sums, in bytes.
  static size_t bytes_needed(int width, int height, size_t channels, std::optional<PixelFilter> splat);

  /// The pixels that a sample counts for, and the weight of the sample in each of them.
  class Footprint;
  /// Returns the footprint of a sample. `offset`: position of the sample relative to the centre of its pixel,
  /// in pixels. With a splat filter, it must be at most half a pixel along each axis.
  Footprint footprint(const V2f& offset) const;

  /// Adds the values of a sample of pixel (x, y), times its weights. `first`: values of the first channels.
  /// `others`: values of the channels after these.
  void add(int x, int y, const Footprint& footprint, std::span<const float> first,
           std::span<const float> others = {});
  /// Adds the weights of a sample of pixel (x, y) to the total weights, by which mean() divides the sums.
  /// Call once per sample.
  void add_weight(int x, int y, const Footprint& footprint);

  /// Returns the memory of the sums.
  std::span<float> values() { return sums_; }

  /// Returns the weighted mean of a channel of pixel (x, y); 0 where nothing was added. `samples`: count of
  /// samples by pixel, row by row. Where the tiles of splatted samples have different counts, the sums of
  /// each tile are divided by its count, so that the filter keeps its shape.
  float mean(int x, int y, size_t channel, std::span<const uint32_t> samples) const;

 private:
  template <class Use>
  void for_each_pixel(int x, int y, const Footprint& footprint, const Use& use);
  size_t tile_offset(int column, int row) const;

  int width_, height_, columns_, rows_;
  int reach_;        // pixels by which a buffer extends beyond its tile on each side
  int buffer_side_;  // pixels: kTileSide + 2 * reach_
  size_t stride_;    // floats per pixel: the channels, then the total weight
  std::optional<PixelFilter> splat_;
  std::vector<float> sums_;
};

class FilmSums::Footprint {
  friend class FilmSums;
  struct Axis {
    int first = 0;  // the first pixel, relative to the sample's pixel
    int count = 1;
    std::array<float, 3> weights{1};
  };
  Axis across, down;
};

}  // namespace pelage
