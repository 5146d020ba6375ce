// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "render/fibre/fibre_frame.h"
#include "render/fibre/medulla_bsdf.h"
#include "render/fibre/wigner.h"

namespace pelage {

/// The lobe cos(theta) / pi^2 (1 + b cos(phi)), where b in [-1, 1] is the balance: the diffuse shell of the
/// cone-shell model.
class WignerScatter {
 public:
  explicit WignerScatter(float balance) : balance_(balance) {}

  float density(const FibreAngles& a) const {
    return a.cos_theta / (kPi * kPi) * (1 + balance_ * std::cos(a.phi));
  }
  SampledAngles draw(const V3f& u) const {
    const float phi = 2 * kPi * u.x;
    const bool turned = u.z < -balance_ * std::cos(phi);
    return {WignerTable::instance().sample(u.y), turned ? phi + kPi : phi};
  }

 private:
  float balance_;
};

}  // namespace pelage
