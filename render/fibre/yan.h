// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "render/fibre/medulla_bsdf.h"
#include "render/fibre/medulla_tables.h"
#include "render/fibre/path_lengths.h"
#include "render/fibre/wigner_scatter.h"
#include "render/material/yan_params.h"

namespace pelage {

using YanFastBsdf = MedullaBsdf<WignerScatter>;
using YanBsdf = MedullaBsdf<TabulatedScatter>;

/// Light at one h before the medulla scatters it [Yan17, section 4]: with T what a leg of the way leaves
/// unscattered, R = F, the unscattered ways are those of a clear fibre whose legs transmit T, and
/// (1 - F) (1 - T) / (1 - F T) is scattered; these add up to 1.
struct MedullaCrossing {
  MedullaCrossing(const YanOptics& optics, float sin_theta, float cos_theta, float h);

  FibreCrossing surface;
  float in_cortex, in_medulla;  ///< 3-D lengths of a leg
  float unscattered;            ///< T
  float scattered() const {
    const float f = surface.reflectance;
    return (1 - f) * (1 - unscattered) / std::max(1 - f * unscattered, 1e-6f);
  }
};

/// What `yan` and `yan-fast` share: everything but the lobe of scattered light.
///
/// Longitudinal functions are those of d'Eon with the variances of the paper's Gaussians, so that energy is
/// exact: there is no variant with the Gaussians themselves, which at a width of 10 degrees lose 2 % of the
/// light across the fibre and 6 % of that from 1.3 radians. R is a product, where [Yan17] lets its cone and
/// its width vary with the azimuth: light traced through a smooth cylinder without tilt knows no such
/// variation, and the tilts are of two or three degrees. Azimuthal functions are Gaussians of deviation
/// sqrt(p + 1) beta_n. Tilts have the signs of ChiangMaterial: +2 alpha for R, -alpha for TT, -3 alpha for
/// TRT.
class MedullaFibre {
 public:
  explicit MedullaFibre(const YanOptics& optics);

  const YanOptics& optics() const { return optics_; }
  SeparableBsdf<WrappedGaussian> straight(const FibreFrame& frame, const MedullaCrossing& crossing,
                                          const Rgb& sigma_ca, const Rgb& sigma_ma) const;

 private:
  YanOptics optics_;
  LobeWidths<WrappedGaussian> widths_;
};

/// Constants of a `yan-fast` material. Scattered light leaves as rho = A cos(theta_i) / pi^2 (1 + b
/// cos(phi)), what light traced through such fibres does nearly; b and the lengths that A is absorbed over
/// are found by tracing, by inclination, when the material is made.
class YanFastMaterial {
 public:
  explicit YanFastMaterial(const YanFastParams& params);
  /// `absorption` is that of cortex and medulla where the material gives none.
  YanFastBsdf at(const FibreFrame& frame, float h, const Rgb& absorption) const;

 private:
  struct Scattering {
    PathLengths lengths;
    float balance = 0;
  };
  static constexpr int kInclinations = 4;
  Scattering scattering_at(float sin_theta) const;

  MedullaFibre fibre_;
  std::array<Scattering, kInclinations> scattering_;  // over |sin theta_o|
};

/// Constants of a `yan` material: scattered light by tables over inclination and h. Refers to the tables,
/// which it shares.
class YanMaterial {
 public:
  explicit YanMaterial(const YanParams& params);
  /// As in YanFastMaterial.
  YanBsdf at(const FibreFrame& frame, float h, const Rgb& absorption) const;

 private:
  MedullaFibre fibre_;
  std::shared_ptr<const MedullaTables> tables_;
};

}  // namespace pelage
