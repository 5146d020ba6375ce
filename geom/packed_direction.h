// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "base/vector.h"

namespace pelage {

/// Packs a line through the origin into two multiples of 1/255 in [0, 1], with an error of at most about a
/// degree. Flips the direction so that z >= 0, projects it to the octahedron |x| + |y| + |z| = 1, and then
/// projects the result along z to a square. Opposite directions give equal values.
inline V2f packed_line(const V3f& direction) {
  const float sum = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
  if (!(sum > 0)) return V2f(1);
  const V3f p = direction / (direction.z < 0 ? -sum : sum);
  const auto rounded = [](float x) { return std::round(255 * (0.5f + 0.5f * x)) / 255; };
  return {rounded(p.x + p.y), rounded(p.x - p.y)};  // the diamond fills the square
}

/// Returns the unit direction with z >= 0 of a packed line.
inline V3f unpacked_line(const V2f& packed) {
  const float a = 2 * packed.x - 1, b = 2 * packed.y - 1;
  const float x = 0.5f * (a + b), y = 0.5f * (a - b);
  return V3f(x, y, 1 - std::abs(x) - std::abs(y)).normalized();
}

}  // namespace pelage
