// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/film/film_test.cpp.
#pragma once

#include <cstdint>
#include <limits>

#include "base/vector.h"

namespace pelage {

inline constexpr uint32_t kNoStrand = 0xffffffffu;

/// The first surface that a camera ray hit. Default values describe an empty pixel.
struct VisibleSurface {
  float depth = std::numeric_limits<float>::infinity();  ///< along the camera axis
  V3f normal{0};                                         ///< unit, world space
  V3f tangent{0};                                        ///< unit, root to tip; zero on skins
  V2f forward{0};                                        ///< pixels to the next frame, x right, y down
  V2f root_uv{0};           ///< texture coordinates of the strand's root or of the skin
  uint32_t id = kNoStrand;  ///< lower half of the strand's id
  float left_out = 0;       ///< fraction of the strands that level of detail omitted here
};

/// The surface of a pixel for data that cannot be averaged (depth, normal, id ...). It is the surface of the
/// front-most sample within the pixel or, if no sample is within the pixel, of the front-most sample of all.
struct FrontSurface {
  VisibleSurface surface;
  bool inside_pixel = false;

  /// Replaces the surface by the surface of another sample if that sample takes precedence. Returns whether
  /// it does.
  bool offer(const VisibleSurface& other, bool inside) {
    const bool first_inside = inside && !inside_pixel;
    const bool nearer = inside == inside_pixel && other.depth < surface.depth;
    if (!first_inside && !nearer) return false;
    surface = other;
    inside_pixel = inside;
    return true;
  }
};

}  // namespace pelage
