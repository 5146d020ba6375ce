// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/fibre/coat_color.h"
#include "render/fibre/fibre_material.h"

namespace pelage {

/// Fraction of uniform light that a tangle of fibres reflects (tangle_reflectance), for a material and a
/// colour.
inline double brightness(const FibreMaterial& material, float color, int walks) {
  return tangle_reflectance(
      [&](const TangleHit& hit, const V3f& u) {
        FibrePoint point;
        point.tangents.fill(hit.tangent);
        point.wo = hit.wo;
        point.h = hit.h;
        point.color = Rgb(color);
        return material.at(point).sample(u);
      },
      walks);
}

}  // namespace pelage
