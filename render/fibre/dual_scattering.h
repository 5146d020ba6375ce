// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/fibre/fibre_averages.h"
#include "render/fibre/fibre_value.h"

namespace pelage {

/// Light that fibres scatter many times, at one point of a fibre, by dual scattering [Zinke08]: an estimate
/// for `indirect: dual` in place of paths. Light comes straight from a light through the strands between,
/// each of which passes on its average (FibreAverages::forward) and blurs it, and is scattered back by the
/// fibres around the point. Refers to the table.
///
/// Deviations from [Zinke08]: the light scattered back is the whole series of reflections of a semi-infinite
/// stack of fibres instead of its first two terms, because pale fur loses 45 % of it otherwise; the lobes are
/// normalised over the sphere (LongitudinalLobe), so that no light is gained; there are no density
/// factors, because rays count the strands that are there; and the strands between have the colour of the
/// point.
class DualScattering {
 public:
  DualScattering(const FibreAverageTable& table, const V3f& tangent, const V3f& wo, const Rgb& color);

  /// Light that arrives from one direction. Refers to the DualScattering.
  class Arriving {
   public:
    Arriving(const DualScattering& dual, const V3f& wi);

    /// Returns the number of strands that leave less than 3 % of the light; at most 64.
    float max_strands() const;

    /// Returns the scattering of the light after it has crossed `strands` strands; infinity: none arrives.
    /// `through`: fraction that arrives without meeting any of them, which the fibre scatters as `direct`.
    /// All other light goes to the group `diffuse`. The result keeps the density of `direct`.
    FibreValue eval(const FibreValue& direct, float strands, float through) const;

   private:
    const FibreFrame& frame_;
    FibreAngles in_;
    FibreAverages fibre_;
  };
  Arriving arriving(const V3f& wi) const { return Arriving(*this, wi); }

  /// Returns a rough guess of the light that the fibre scatters in total if its light from `wi` has crossed
  /// one strand: to choose among lights, faster than eval().
  Rgb likely(const V3f& wi) const;

 private:
  const FibreAverageTable* table_;
  FibreFrame frame_;
  FibreAverageTable::ColorSteps color_;
};

/// Returns the fraction of light that a semi-infinite stack of fibres with the averages a_f and a_b sends
/// back through a fibre in front of it: the series of [Zinke08, equations 10 to 14] with all its terms, a_f^2
/// R / (1 - a_b R), where R is the reflectance of the stack.
float stack_backscatter(float forward, float backward);

}  // namespace pelage
