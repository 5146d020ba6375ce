// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "base/vector.h"
#include "render/accel/fur/snapped_strands.h"

namespace pelage {

struct FurBox;

/// The axes along which all boxes of one fur tree stand: those of the grid, or others at right angles to each
/// other. Combed fur has one main direction, and boxes along it are much smaller; a ray is turned once for
/// the whole tree. Curves, and what rays are said to hit, know nothing of it.
struct FurFrame {
  std::array<V3f, 3> axes{V3f(1, 0, 0), V3f(0, 1, 0), V3f(0, 0, 1)};
  bool turned = false;  ///< false: the axes are those of the grid, exactly

  V3f operator()(const V3f& p) const { return {axes[0].dot(p), axes[1].dot(p), axes[2].dot(p)}; }
  SnappedSegment operator()(const SnappedSegment& segment) const;
  /// A box along the axes of the grid around one that stands in this frame.
  FurBox unrotated(const FurBox& box) const;
  /// The same axes, turned or not.
  bool operator==(const FurFrame& o) const { return turned == o.turned && (!turned || axes == o.axes); }
  /// Whether it may come from a file.
  bool is_possible() const;
};

/// Which frames a tree may have. Trees over moving strands stand along the grid always.
enum class FurRotation : uint8_t {
  kNever,
  kWhenUseful,  ///< where boxes of single segments are so much smaller that boxes of four are, too
  kAlways,      ///< for tests
};

/// A frame that is good for most segments, found from a few hundred of them: the direction that they have in
/// common as one axis, and of several pairs of others the best. The same for the same strands.
FurFrame choose_frame(const SnappedStrands& strands, FurRotation rotation);

}  // namespace pelage
