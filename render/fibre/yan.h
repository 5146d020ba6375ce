// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <memory>

#include "render/fibre/fibre_frame.h"
#include "render/fibre/medulla_bsdf.h"
#include "render/fibre/medulla_tables.h"
#include "render/fibre/path_lengths.h"
#include "render/fibre/wigner.h"
#include "render/material/yan_params.h"

namespace pelage {

/// The lobe cos(theta) / pi^2 (1 + b cos(phi)), where b in [-1, 1] is the balance: the diffuse shell of the
/// cone-shell model.
class WignerScatter {
 public:
  explicit WignerScatter(float balance) : balance_(balance) {}

  float density(const FibreAngles& a) const {
    return a.cos_theta / (kPi * kPi) * (1 + balance_ * std::cos(a.phi));
  }
  SampledAngles sample(const V3f& u) const {
    const float phi = 2 * kPi * u.x;
    const bool turned = u.z < -balance_ * std::cos(phi);
    return {WignerTable::instance().sample(u.y), turned ? phi + kPi : phi};
  }

 private:
  float balance_;
};

using YanFastBsdf = MedullaBsdf<WignerScatter>;
using YanBsdf = MedullaBsdf<TabulatedScatter>;

/// Splits the light that hits a fibre at one h into light that the medulla scatters and light that it does
/// not [Yan17, section 4]. F is the reflectance of the surface, and also the fraction of the light in the R
/// lobe. T is the fraction of a leg's light that the medulla does not scatter. Unscattered light follows the
/// paths of a clear fibre whose legs transmit T. The fraction (1 - F) (1 - T) / (1 - F T) of the light is
/// scattered. The fractions of all unscattered paths and of scattered light add up to 1.
struct MedullaCrossing {
  MedullaCrossing(const YanOptics& optics, float sin_theta, float cos_theta, float h);

  FibreCrossing surface;
  float in_cortex, in_medulla;  ///< 3-D path lengths within a leg
  float unscattered;            ///< T
  float scattered() const {
    const float f = surface.reflectance;
    return (1 - f) * (1 - unscattered) / std::max(1 - f * unscattered, 1e-6f);
  }
};

/// What the models `yan` and `yan-fast` share: everything except the lobe of scattered light.
///
/// Longitudinal functions have d'Eon's form and the variances of the Gaussians in [Yan17], so that energy is
/// exact. There is no variant with the Gaussians themselves: at a width of 10 degrees, they lose 2 % of light
/// from theta_o = 0 and 6 % of light from theta_o = 1.3 radians. The R lobe is a product of a longitudinal
/// and an azimuthal function. In [Yan17], the cone and the width of the R lobe vary with the azimuth.
/// However, light traced through a smooth cylinder without tilt shows no such variation, and tilts are only
/// two or three degrees. Azimuthal functions are Gaussians with standard deviation sqrt(p + 1) beta_n, where
/// p is 0 for R, 1 for TT and 2 for TRT. Tilts have the same signs as in ChiangMaterial: +2 alpha for R,
/// -alpha for TT, -3 alpha for TRT.
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
/// cos(phi)), which approximates light traced through such fibres. b, and the path lengths that determine A,
/// are found for several inclinations by tracing paths when the material is made.
class YanFastMaterial {
 public:
  explicit YanFastMaterial(const YanFastParams& params);
  /// `absorption`: absorption coefficient per radius, used for the cortex or the medulla if the material does
  /// not define one.
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

/// Constants of a `yan` material, which takes scattered light from tables over inclination and h. Keeps the
/// tables alive; several materials may share them.
class YanMaterial {
 public:
  explicit YanMaterial(const YanParams& params);
  /// `absorption`: as for YanFastMaterial::at().
  YanBsdf at(const FibreFrame& frame, float h, const Rgb& absorption) const;

 private:
  MedullaFibre fibre_;
  std::shared_ptr<const MedullaTables> tables_;
};

}  // namespace pelage
