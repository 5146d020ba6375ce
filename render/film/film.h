// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/ledger.h"
#include "image/exr.h"
#include "render/film/film_layers.h"
#include "render/film/film_sums.h"
#include "render/film/visible_surface.h"
#include "render/sampling/pixel_moments.h"

namespace pelage {

/// Result of one camera sample of a pixel.
struct FilmSample {
  Rgb radiance{0};
  float alpha = 0;
  VisibleSurface surface;
  V2f offset{0};  ///< from the centre of the pixel to the camera ray, in pixels

  /// Returns whether the camera ray passes through the pixel itself. A filter wider than a pixel also has
  /// samples outside the pixel.
  bool inside_pixel() const { return std::max(std::abs(offset.x), std::abs(offset.y)) <= 0.5f; }
};

/// The picture. For each pixel, it stores weighted sums of the samples. Data that cannot be averaged (depth,
/// normal, id ...) comes from one sample of the pixel, see FrontSurface.
///
/// Thread safety: threads may write different tiles (squares of FilmSums::kTileSide pixels) at the same time.
/// The callers ensure that only one thread at a time writes a tile, and that the samples of a tile are always
/// added in the same order. The sums then do not depend on the number of threads.
class Film {
 public:
  /// Charges the memory of the film to `ledger`.
  Film(int width, int height, FilmLayers layers, MemoryLedger& ledger);
  /// Returns the memory, in bytes, that a film of this size needs.
  static int64_t bytes_needed(int width, int height, const FilmLayers& layers);

  /// Returns the moments of the estimates of each pixel's luminance, row by row. Empty unless layers().noise.
  const std::vector<PixelMoments>& moments() const { return moments_; }

  int width() const { return width_; }
  int height() const { return height_; }
  const FilmLayers& layers() const { return layers_; }

  /// Adds a sample of pixel (x, y). `by_layer`: the sample's radiance divided among layers(), one entry per
  /// layer. When the radiance, alpha or an entry is not finite, returns false and only counts the sample.
  bool add(int x, int y, const FilmSample& sample, std::span<const Rgb> by_layer);
  /// Adds an estimate of the luminance of pixel (x, y): the mean of some of its own samples, which share
  /// nothing with its other samples. Only with layers().noise.
  void add_estimate(int x, int y, double luminance, uint32_t samples) {
    moments_[index(x, y)].add(luminance, samples);
  }

  /// Returns how many samples of the pixel add() was given.
  uint32_t samples(int x, int y) const { return counts_[index(x, y)]; }
  // Min and sum of samples() over the pixels of a box.
  uint32_t min_samples(const PixelBox& box) const;
  double sample_sum(const PixelBox& box) const;
  // Weighted means of the samples that count for a pixel; 0 if there are none. Where splatted samples of
  // tiles with different sample counts meet, each tile counts as if it had one sample per pixel.
  Rgb radiance(int x, int y) const;
  float alpha(int x, int y) const;
  Rgb layer(int x, int y, size_t layer) const;
  /// Returns the indirect part of layers().scattered(light, group). Only with layers().events.
  Rgb indirect(int x, int y, size_t light, int group) const;
  const VisibleSurface& surface(int x, int y) const { return surfaces_[index(x, y)].surface; }

  /// Returns the memory that add() changes, in blocks. A film of the same size and layers with the same bytes
  /// in its blocks is the same film.
  std::vector<std::span<std::byte>> state();

  /// Returns all channels of rows y0 .. y1-1. As half: R G B A and the light layers. As float: Z, N, tangent,
  /// forward, root and id.X (id_float()). As uint: id. With layers().noise, there are two more channels:
  /// `samples` as uint, and `noise`, the standard error of the luminance, as float. With layers().lod, there
  /// is `lod` as float.
  std::vector<ExrChannel> exr_rows(int y0, int y1) const { return exr_pixels({0, y0, width_, y1}); }
  /// Returns all channels of the pixels of a box, row by row, after make_positive(). With `wanted`, returns
  /// only those whose name it accepts, as they are. The box may be empty.
  std::vector<ExrChannel> exr_pixels(const PixelBox& box,
                                     const std::function<bool(const std::string& name)>& wanted = {}) const;

 private:
  size_t index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
  }
  static size_t channel_count(const FilmLayers& layers) { return first_channel(layers.size()); }
  float mean(int x, int y, size_t channel) const { return sums_.mean(x, y, channel, counts_); }
  /// Returns the index of a layer's red channel among the channels of sums_.
  static size_t first_channel(size_t layer) { return 4 + 3 * layer; }

  int width_, height_;
  FilmLayers layers_;
  FilmSums sums_;  // channels: R G B A, then 3 per layer
  std::vector<uint32_t> counts_;
  std::vector<FrontSurface> surfaces_;
  std::vector<PixelMoments> moments_;  // of add_estimate(); empty unless layers().noise
  MemoryCharge charge_;
};

}  // namespace pelage
