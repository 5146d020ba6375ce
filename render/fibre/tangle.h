// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "render/fibre/fibre_value.h"

namespace pelage {

/// Where a walk through a tangle meets a fibre.
struct TangleHit {
  V3f tangent{0};
  V3f wo{0};    ///< unit, back to where the walk came from
  float h = 0;  ///< across the fibre, as FibrePoint::h
};
/// Scatters a walk at a fibre, by three numbers in [0, 1); nothing when it ends there.
using TangleScatter = std::function<std::optional<FibreSample>(const TangleHit&, const V3f&)>;

/// How much of even light an endless depth of fibres gives back that lie every way: the colour of much such
/// fur together. Green alone. Found by `walks` random walks, the same for every call: good to about 1 /
/// sqrt(walks) of itself. 2 when fibres give back so much more than they get that there is no such number.
double tangle_reflectance(const TangleScatter& scatter, int walks);

}  // namespace pelage
