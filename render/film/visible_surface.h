// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#include "base/vector.h"

namespace pelage {

/// VisibleSurface::id of skins and of empty pixels.
inline constexpr uint32_t kNoStrand = 0xffffffffu;

/// The first surface that a camera ray hit. Default values describe an empty pixel.
struct VisibleSurface {
  float depth = std::numeric_limits<float>::infinity();  ///< distance from the camera along the view axis
  V3f normal{0};                                         ///< unit, world space
  V3f tangent{0};                                        ///< unit, from root to tip; zero on skins
  V2f forward{0};           ///< motion until the next frame, in pixels: x right, y down
  V2f root_uv{0};           ///< texture coordinates of the strand's root or of the skin
  uint32_t id = kNoStrand;  ///< lower 32 bits of the strand's id
  float left_out = 0;       ///< fraction of the strands that level of detail omitted here
};

/// Returns an id as a float for programs that do not read integer channels: its bits, by the rule of the
/// Cryptomatte specification 1.2. Where they would not be a normal float, the lowest bit of the exponent is
/// flipped. 0 for kNoStrand.
inline float id_float(uint32_t id) {
  if (id == kNoStrand) return 0;
  const uint32_t exponent = id >> 23 & 255;
  return std::bit_cast<float>(exponent == 0 || exponent == 255 ? id ^ 1u << 23 : id);
}

/// The surface that provides a pixel's data that cannot be averaged (depth, normal, id ...). It is the
/// nearest surface that any sample inside the pixel sees. If no sample is inside the pixel, it is the nearest
/// surface that any sample of the pixel sees.
struct FrontSurface {
  VisibleSurface surface;
  uint32_t inside_pixel = 0;  ///< 1 if a sample inside the pixel sees the surface, otherwise 0

  /// Replaces the surface by `other` if the sample that sees `other` takes precedence. Returns whether it was
  /// replaced. `inside`: whether that sample is inside the pixel.
  bool offer(const VisibleSurface& other, bool inside) {
    if (!yields_to(other.depth, inside)) return false;
    surface = other;
    inside_pixel = inside ? 1 : 0;
    return true;
  }
  /// Returns whether offer() would replace the surface by one at `depth`.
  bool yields_to(float depth, bool inside) const {
    const bool first_inside = inside && inside_pixel == 0;
    const bool nearer = inside == (inside_pixel != 0) && depth < surface.depth;
    return first_inside || nearer;
  }
};

}  // namespace pelage
