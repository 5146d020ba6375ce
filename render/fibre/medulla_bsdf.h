// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "render/fibre/azimuthal.h"
#include "render/fibre/separable_bsdf.h"

namespace pelage {

/// A fibre with a medulla, hit at one h: the lobes of unscattered light, and one lobe of scattered light.
/// `Scattered` is the model of the lobe of scattered light. It must have density(FibreAngles) and sample(u),
/// which returns SampledAngles.
///
/// Every lobe is sampled exactly, so sample weights vary only because the lobes differ in colour.
template <class Scattered>
class MedullaBsdf {
 public:
  MedullaBsdf(const SeparableBsdf<WrappedGaussian>& straight, const Scattered& scattered,
              const Rgb& amplitude)
      : straight_(straight), scattered_(scattered), amplitude_(amplitude) {
    const Rgb a = straight_.albedo();
    const float s = amplitude_.x + amplitude_.y + amplitude_.z, total = s + a.x + a.y + a.z;
    choice_ = total > 0 ? s / total : 0;
  }

  FibreValue eval(const V3f& wi) const {
    const FibreAngles a = straight_.frame().angles(wi);
    FibreValue value = straight_.eval(a);
    const float density = scattered_.density(a);
    value[LobeGroup::kDiffuse] += amplitude_ * density;
    value.pdf = (1 - choice_) * value.pdf + choice_ * density;
    return value;
  }

  std::optional<FibreSample> sample(const V3f& u) const {
    FibreSample s;
    if (u.z < choice_) {
      const auto [sine, phi] = scattered_.sample({u.x, u.y, std::min(u.z / choice_, kBelowOne)});
      s.wi = straight_.frame().direction(sine, std::sqrt(std::max(0.0f, (1 - sine) * (1 + sine))), phi);
    } else {
      s.wi = straight_.sample_direction({u.x, u.y, std::min((u.z - choice_) / (1 - choice_), kBelowOne)});
    }
    s.value = eval(s.wi);
    if (!(s.value.pdf > 0)) return std::nullopt;
    return s;
  }

  Rgb albedo() const { return straight_.albedo() + amplitude_; }

 private:
  SeparableBsdf<WrappedGaussian> straight_;
  Scattered scattered_;
  Rgb amplitude_;
  float choice_;
};

/// A sampled direction relative to a fibre: the sine of its inclination, and its azimuth in radians.
struct SampledAngles {
  float sin_theta;
  float phi;
};

}  // namespace pelage
