// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "render/fibre/fibre_value.h"

namespace pelage {

/// The point at which a random walk through a dense medium of fibres hits a fibre.
struct TangleHit {
  V3f tangent{0};
  V3f wo{0};    ///< unit, back along the walk
  float h = 0;  ///< position across the fibre, as FibrePoint::h
};
/// Samples the direction in which a walk leaves a fibre, using three random numbers in [0, 1). Empty when the
/// walk ends at this fibre.
using TangleScatter = std::function<std::optional<FibreSample>(const TangleHit&, const V3f&)>;

/// The directions of the fibres of a medium whose surface is z = 0: normalised sums of a direction in the xz
/// plane and of a normally distributed vector.
struct FibreLay {
  float rise = 0;  ///< angle of the direction above the surface, radians
  float spread =
      0;  ///< standard deviation of each coordinate of the vector; 0: all directions are equally likely

  /// All directions are equally likely.
  static FibreLay tangle() { return {}; }
  /// A combed coat: hair rises by 30 degrees, neighbours differ by about 20.
  static FibreLay coat() { return {0.52f, 0.3f}; }
};

/// Returns the fraction of uniform light that an infinitely deep medium of fibres reflects: the colour of
/// dense fur. Uses the green channel only. The fraction is estimated with `walks` random walks,
/// which use the same random numbers in every call. The relative error is about 1 / sqrt(walks). Returns 2
/// when fibres gain so much energy that the sum diverges.
double tangle_reflectance(const TangleScatter& scatter, int walks, const FibreLay& lay = FibreLay::coat());

}  // namespace pelage
