// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "base/ledger.h"
#include "image/exr.h"
#include "render/film/film_layers.h"
#include "render/film/film_sums.h"
#include "render/film/visible_surface.h"
#include "render/sampling/pixel_moments.h"

namespace pelage {

/// Result of one path.
struct FilmSample {
  Rgb radiance{0};
  float alpha = 0;
  VisibleSurface surface;
  V2f offset{0};  ///< offset of the camera ray from the centre of the pixel, in pixels

  /// Whether the camera ray passed within the pixel itself, not only within its filter.
  bool inside_pixel() const { return std::max(std::abs(offset.x), std::abs(offset.y)) <= 0.5f; }
};

/// Sums over all samples of a picture, per pixel. Data that cannot be averaged comes from FrontSurface.
///
/// Thread safety: different tiles (FilmSums::kTileSide) may be written at once. One thread at a time adds the
/// samples of a tile, always in the same order, so the sums do not depend on the number of threads.
class Film {
 public:
  Film(int width, int height, FilmLayers layers, MemoryLedger& ledger);
  /// Memory that a film of this size needs.
  static int64_t bytes_needed(int width, int height, const FilmLayers& layers);

  /// Moments of the luminance of each pixel's samples, row by row; empty unless layers().noise.
  const std::vector<PixelMoments>& moments() const { return moments_; }

  int width() const { return width_; }
  int height() const { return height_; }
  const FilmLayers& layers() const { return layers_; }

  /// `by_layer`: the radiance divided among layers(). Returns false and leaves the pixel unchanged when a
  /// value is not finite.
  bool add(int x, int y, const FilmSample& sample, std::span<const Rgb> by_layer);
  /// Removes all samples of the tile that contains the pixel.
  void clear_tile(int x, int y);

  uint32_t samples(int x, int y) const { return counts_[index(x, y)]; }
  Rgb radiance(int x, int y) const;
  float alpha(int x, int y) const;
  Rgb layer(int x, int y, size_t layer) const;
  /// The indirect part of a light layer. Only with layers().events.
  Rgb indirect(int x, int y, size_t light, int group) const;
  const VisibleSurface& surface(int x, int y) const { return surfaces_[index(x, y)].surface; }

  /// All channels of rows y0 .. y1-1: R G B A and light layers as half, Z, N, tangent, forward and root as
  /// float, id as uint; with layers().noise, `samples` as uint and `noise`, the standard error of the
  /// luminance, as float; with layers().lod, `lod` as float.
  std::vector<ExrChannel> exr_rows(int y0, int y1) const;

 private:
  size_t index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
  }
  static size_t channel_count(const FilmLayers& layers) { return first_channel(layers.size()); }
  /// Index in sums_ of the red channel of a layer.
  static size_t first_channel(size_t layer) { return 4 + 3 * layer; }

  int width_, height_;
  FilmLayers layers_;
  FilmSums sums_;  // R G B A, then 3 per layer
  std::vector<uint32_t> counts_;
  std::vector<FrontSurface> surfaces_;
  std::vector<PixelMoments> moments_;  // of the luminance; empty unless layers().noise
  MemoryCharge charge_;
};

}  // namespace pelage
