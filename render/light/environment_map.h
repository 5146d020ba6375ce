// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "base/vector.h"
#include "image/image.h"

namespace pelage {

/// Directions drawn from a lat-long image in proportion to its luminance, at full resolution.
///
/// Space of the image: +y up (row 0), the centre column along -z, +x to its right. Radiance is constant in
/// each texel, and texels are sampled uniformly over their exact solid angle, so that density and radiance
/// are proportional everywhere, poles included: nothing that shines has density zero. One float per texel and
/// a guide of one number per 16 texels are kept. Immutable; thread safe.
class EnvironmentMap {
 public:
  /// The image must outlive the map: its first three channels (or its only one) times `factor` are the
  /// radiance. Negative values count as black. Throws Error (kInput) for an empty image and for values that
  /// are not finite.
  EnvironmentMap(const Image& image, const Rgb& factor);

  struct Texel {
    int x, y;
  };
  struct Draw {
    V3f direction;
    Texel texel;
  };
  /// Nothing may be drawn from a black map.
  Draw sample(const V2f& u) const;
  Texel texel_of(const V3f& direction) const;
  Rgb radiance(Texel texel) const;
  /// Density of sample() per solid angle anywhere in the texel.
  float pdf(Texel texel) const { return luminance(radiance(texel)) * inverse_power_; }
  /// Integral of luminance over the sphere.
  double power() const { return power_; }
  /// Solid angle of each texel of a row.
  double texel_solid_angle(int row) const;
  size_t bytes() const;

 private:
  const Image& image_;
  Rgb factor_;
  double power_ = 0;
  float inverse_power_ = 0;
  std::vector<double>
      row_cosine_;              ///< of the polar angle at the upper edge of each row, and at the lowest edge
  std::vector<float> row_cdf_;  ///< inclusive
  std::vector<uint32_t> row_guide_;
  std::vector<float> column_cdf_;  ///< inclusive, row after row
  std::vector<uint32_t> column_guide_;
  size_t column_guide_size_ = 0;  ///< per row
};

}  // namespace pelage
