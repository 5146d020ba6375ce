// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "base/vector.h"
#include "image/texture.h"

namespace pelage {

/// Samples directions from a lat-long image in proportion to its luminance, at full resolution.
///
/// Space of the image: +y up (row 0), the centre column along -z, +x to its right. Radiance is constant
/// within each texel, and texels are sampled uniformly over their exact solid angle, so that density and
/// radiance are proportional everywhere, including the poles: no direction with radiance has density zero.
///
/// The distribution has at most kMaxCells cells, whatever the size of the image: for larger images, a cell is
/// a square of texels, and sampling examines all texels of the selected cell. Stores one float and a
/// sixteenth of an integer per cell. Immutable; thread safe.
class EnvironmentMap {
 public:
  static constexpr int64_t kMaxCells = int64_t(1) << 21;

  /// The radiance is the first three channels (or the only one) of `image` times `factor`. Negative values
  /// count as black. `check_stop` is called often and may throw. Throws Error (kInput) for an empty image and
  /// for non-finite values.
  EnvironmentMap(std::shared_ptr<const Texture> image, const Rgb& factor,
                 const std::function<void()>& check_stop = {}, int64_t max_cells = kMaxCells);

  struct Texel {
    int x, y;
  };
  struct Draw {
    V3f direction;
    Texel texel;
  };
  /// The map must not be black.
  Draw sample(const V2f& u) const;
  Texel texel_of(const V3f& direction) const;
  Rgb radiance(Texel texel) const { return shown(image_->texel(texel.x, texel.y)); }
  /// Density of sample() per solid angle anywhere in a texel with this radiance.
  float pdf(const Rgb& radiance) const { return luminance(radiance) * inverse_power_; }
  float pdf(Texel texel) const { return pdf(radiance(texel)); }
  /// Integral of luminance over the sphere.
  double power() const { return power_; }
  /// Solid angle of each texel of a row.
  double texel_solid_angle(int row) const;
  /// Memory without the image.
  size_t bytes() const { return bytes(image_->width(), image_->height(), cell_); }
  /// Memory of the map of an image of this size, without the image.
  static size_t bytes_for(int width, int height, int64_t max_cells = kMaxCells);

 private:
  /// A texel, and a position within it.
  struct Place {
    Texel texel;
    V2f rest;
  };
  static int cell_side(int width, int height, int64_t max_cells);
  static size_t bytes(int width, int height, int cell);
  Rgb shown(const Rgb& stored) const;
  void measure_band(int row, const std::function<void()>& check_stop);
  Place place_in_cell(size_t column, size_t row, const V2f& rest) const;

  std::shared_ptr<const Texture> image_;
  Rgb factor_;
  int cell_ = 1;     ///< texels a side, a power of two
  int columns_ = 0;  ///< of cells
  int rows_ = 0;
  double power_ = 0;
  float inverse_power_ = 0;
  std::vector<double> row_cosine_;  ///< of the polar angle at the upper edge of each row of texels, and at
                                    ///< the lowest edge
  std::vector<float> row_cdf_;      ///< of cells, inclusive
  std::vector<uint32_t> row_guide_;
  std::vector<float> column_cdf_;  ///< of cells, inclusive, row by row
  std::vector<uint32_t> column_guide_;
  size_t column_guide_size_ = 0;  ///< per row
};

}  // namespace pelage
