// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "base/vector.h"
#include "render/accel/fur/snapped_strands.h"

namespace pelage {

struct FurBox;

/// The axes of all boxes of one fur tree: the axes of the grid, or a rotated orthogonal frame. Combed fur has
/// one main direction, and boxes aligned to it are much smaller; a ray is rotated once for the whole tree.
/// Curves and hits are not affected.
struct FurFrame {
  std::array<V3f, 3> axes{V3f(1, 0, 0), V3f(0, 1, 0), V3f(0, 0, 1)};
  bool turned = false;  ///< false: exactly the axes of the grid

  V3f operator()(const V3f& p) const { return {axes[0].dot(p), axes[1].dot(p), axes[2].dot(p)}; }
  SnappedSegment operator()(const SnappedSegment& segment) const;
  /// A box along the axes of the grid that contains a box of this frame.
  FurBox unrotated(const FurBox& box) const;
  /// Whether both have the same axes, rotated or not.
  bool operator==(const FurFrame& o) const { return turned == o.turned && (!turned || axes == o.axes); }
  /// Whether it is well-formed, for data from a file.
  bool is_possible() const;
};

/// The frames a tree may use. Trees over moving strands always use the grid's axes.
enum class FurRotation : uint8_t {
  kNever,
  kWhenUseful,  ///< if rotation makes the boxes of single segments so much smaller that boxes of four
                ///< segments shrink, too
  kAlways,      ///< for tests
};

/// A frame that suits most segments, estimated from a few hundred segments. One axis is the common direction
/// of the segments; the other two axes are the best of several pairs. Deterministic.
FurFrame choose_frame(const SnappedStrands& strands, FurRotation rotation);

}  // namespace pelage
