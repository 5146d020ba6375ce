// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "image/exr.h"
#include "lab/pictures/plane.h"

namespace pelage {

/// Selects the pixels over which errors are averaged: those that both references show.
enum class ErrorRegion {
  kSurfaces,  ///< alpha is not 0
  kFur,       ///< the squared length of the layer `tangent` is greater than 0.05
};

/// Returns 1 where both pictures show the region, and 0 elsewhere. Empty when the pictures differ in size or
/// lack the layer of the region.
std::optional<Plane> region_of(const ExrImage& a, const ExrImage& b, ErrorRegion region);

/// Returns R, G and B of a picture. Empty when one of them is missing.
std::optional<std::array<Plane, 3>> color_planes(const ExrImage& image);

}  // namespace pelage
