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
/// Space of the image: row 0 is at +y (up), the centre column is along -z, and +x is to the right of the
/// centre. Radiance is constant within each texel, and each texel is sampled uniformly over its exact solid
/// angle. Density is therefore proportional to luminance everywhere, including the poles. No direction with
/// luminance has density zero.
///
/// The distribution has at most kMaxCells cells. In images with more texels, a cell is a square of texels,
/// and sampling examines all texels of the selected cell. The tables need about 4.25 bytes per cell.
/// Immutable; thread safe.
class EnvironmentMap {
 public:
  /// Max count of cells, for images of up to about 8 billion texels.
  static constexpr int64_t kMaxCells = int64_t(1) << 21;

  /// The radiance is the first three channels of `image` (or its only channel) times `factor`. Negative
  /// values of the image count as 0. `check_stop` is called often and may throw. Throws Error (kInput) for an
  /// empty image and for values that are not finite.
  EnvironmentMap(std::shared_ptr<const Texture> image, const Rgb& factor,
                 const std::function<void()>& check_stop = {}, int64_t max_cells = kMaxCells);

  struct Texel {
    int x, y;
  };
  struct Sample {
    V3f direction;
    Texel texel;
  };
  /// Samples a direction. `u`: two random numbers in [0, 1). The map must not be black everywhere.
  Sample sample(const V2f& u) const;
  /// Returns the texel that contains a direction.
  Texel texel_of(const V3f& direction) const;
  Rgb radiance(Texel texel) const { return shown(image_->texel(texel.x, texel.y)); }
  /// Returns the radiance in a direction, interpolated linearly between the middles of texels: for the
  /// camera, to which large texels would be blocks.
  Rgb interpolated(const V3f& direction) const;
  /// Returns the density of sample(), per solid angle, in a texel with this radiance.
  float pdf(const Rgb& radiance) const { return luminance(radiance) * inverse_power_; }
  float pdf(Texel texel) const { return pdf(radiance(texel)); }
  /// Returns the integral of luminance over the sphere.
  double power() const { return power_; }
  /// Returns the solid angle of one texel of a row, in steradians.
  double texel_solid_angle(int row) const;
  /// Returns the memory of this map in bytes, without the image.
  size_t bytes() const { return bytes(image_->width(), image_->height(), cell_); }
  /// Returns the memory in bytes that the map of an image of this size needs, without the image.
  static size_t bytes_for(int width, int height, int64_t max_cells = kMaxCells);

 private:
  /// A texel, and a position in [0, 1)^2 within it.
  struct Place {
    Texel texel;
    V2f rest;
  };
  /// Position of a direction in the image: columns and rows, with a fraction.
  V2f place_of(const V3f& direction) const;
  static int cell_side(int width, int height, int64_t max_cells);
  static size_t bytes(int width, int height, int cell);
  Rgb shown(const Rgb& stored) const;
  void measure_band(int row, const std::function<void()>& check_stop);
  Place place_in_cell(size_t column, size_t row, const V2f& rest) const;

  std::shared_ptr<const Texture> image_;
  Rgb factor_;
  int cell_ = 1;     ///< side of a cell in texels, a power of two
  int columns_ = 0;  ///< count of columns of cells
  int rows_ = 0;     ///< count of rows of cells
  double power_ = 0;
  float inverse_power_ = 0;
  std::vector<double> row_cosine_;  ///< cosine of the polar angle at the edges of the rows of texels,
                                    ///< from top to bottom
  std::vector<float> row_cdf_;      ///< inclusive, of the rows of cells
  std::vector<uint32_t> row_guide_;
  std::vector<float> column_cdf_;  ///< inclusive, of the cells within each row
  std::vector<uint32_t> column_guide_;
  size_t column_guide_size_ = 0;  ///< entries of column_guide_ per row of cells
};

}  // namespace pelage
