// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "base/vector.h"
#include "geom/strands.h"

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

/// Data at the root of a strand of a thinned coat, packed into three bytes. It consists of the line along the
/// skin's normal when the shutter opens, with an error of up to a degree, and of the share: the fraction of
/// the strands at this root that level of detail keeps.
///
/// Stored as an attribute of the strands, so that it is copied with the strands to batches, chunks, files,
/// and the single strand of a hit. Only this class knows how the attribute is encoded.
class RootDetail {
 public:
  static constexpr size_t kFloats = 3;  ///< number of floats per strand of the attribute

  RootDetail(const V3f& normal, float share);

  /// The normal, unit length. Its sign is arbitrary.
  V3f normal() const;
  /// The fraction of strands kept, in (0, 1]. Exact for 1; otherwise, the error is smaller for smaller
  /// values.
  float share() const { return root_of_share_ * root_of_share_; }

  /// Returns `strands` with root data added; `details` holds the data of each strand.
  static Strands added(Strands strands, const std::vector<RootDetail>& details);
  /// Returns the root data of one strand; empty when the strands have none.
  static std::optional<RootDetail> of(const Strands& strands, size_t strand);

 private:
  RootDetail(const V2f& line, float root_of_share) : line_(line), root_of_share_(root_of_share) {}

  V2f line_;
  float root_of_share_;
};

}  // namespace pelage
