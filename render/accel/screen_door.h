// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/hash.h"

namespace pelage {

/// How a secondary ray sees a strand that is not opaque: as an opaque strand whose width is width * opacity.
/// So such a ray ends at its first crossing instead of passing through many strands.
///
/// The opaque part of the width is a window. Its place across the strand is a random number of the strand,
/// and a window that reaches beyond one edge continues at the other. For a ray that crosses each strand at
/// most once, the mean transmittance over these random numbers is the product of 1 - opacity over the
/// crossings. Two crossings of one strand share its random number. If all windows were in the middle of their
/// strands, strands that coincide would cover each other.
class ScreenDoor {
 public:
  explicit ScreenDoor(uint64_t strand_id, uint32_t part)
      : begin_(unit_float(hash64(strand_id, part, random_use("screen door")))) {}

  /// Whether a ray that crosses the strand at the offset `h` (Hit::v) meets the opaque part.
  bool blocks(float h, float opacity) const { return opacity >= 1 || place(h) < opacity; }
  /// Converts the offset of a ray that is blocked: from an offset across the strand to an offset across the
  /// opaque part, in [-1, 1].
  float offset_inside(float h, float opacity) const {
    return opacity >= 1 ? h : std::clamp(2 * place(h) / opacity - 1, -1.0f, 1.0f);
  }

 private:
  /// Distance from the beginning of the window, in widths of the strand, in [0, 1].
  float place(float h) const {
    const float x = 0.5f * (h + 1) + begin_;
    return x - std::floor(x);
  }
  float begin_;
};

}  // namespace pelage
