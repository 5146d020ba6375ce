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

/// Weighted sums of the channels of a picture. Without a splat filter, sample positions were drawn from the
/// pixel filter, and a sample counts for its own pixel alone, with weight 1. With a splat filter, a sample
/// lies anywhere in its pixel and counts for every pixel whose filter reaches it, weighted by the value of
/// that filter. Twice as many samples then reach a pixel, but neighbouring pixels share noise.
///
/// Splatted samples are added to a buffer of their tile, which overlaps its neighbours by the reach of the
/// filter; a pixel is the sum over at most four buffers, always in the same order. So the result does not
/// depend on which tiles are traced at the same time.
///
/// Thread safety: different tiles may be written at once; without a filter, different pixels.
class FilmSums {
 public:
  /// Side of a tile in pixels. One thread at a time adds the samples of a tile.
  static constexpr int kTileSide = 16;

  FilmSums(int width, int height, size_t channels, std::optional<PixelFilter> splat);
  static size_t bytes_needed(int width, int height, size_t channels, std::optional<PixelFilter> splat);

  /// The pixels that a sample counts for, and its weight in each.
  class Footprint;
  /// Footprint of a sample that lies `offset` pixels from the centre of its pixel; with a splat filter, at
  /// most half a pixel along each axis.
  Footprint footprint(const V2f& offset) const;

  /// Adds a sample of pixel (x, y): `values`, one per channel, starting with channel `first`.
  void add(int x, int y, const Footprint& footprint, size_t first, std::span<const float> values);
  /// Adds a sample's weights to the pixels' total weights, by which the sums are divided. Call once per
  /// sample.
  void add_weight(int x, int y, const Footprint& footprint);

  /// Removes all samples of the tile that contains pixel (x, y).
  void clear_tile(int x, int y);

  /// Weighted mean of a channel; 0 where nothing was added.
  float mean(int x, int y, size_t channel) const;

 private:
  template <class Use>
  void for_each_pixel(int x, int y, const Footprint& footprint, const Use& use);
  size_t tile_offset(int column, int row) const;

  int width_, height_, columns_, rows_;
  int reach_;        // pixels by which buffers overlap
  int buffer_side_;  // of a tile, with the overlap
  size_t stride_;    // floats of a pixel: the channels, then the weight
  std::optional<PixelFilter> splat_;
  std::vector<float> sums_;
};

class FilmSums::Footprint {
  friend class FilmSums;
  struct Axis {
    int first = 0;  // pixel, relative to the sample's pixel
    int count = 1;
    std::array<float, 3> weights{1};
  };
  Axis across, down;
};

}  // namespace pelage
