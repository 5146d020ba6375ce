// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "base/vector.h"
#include "render/accel/fur/snapped_strands.h"

namespace pelage {

struct FurBox;

/// The axes to which all boxes of one fur tree are aligned: the axes of the grid, or a rotated orthogonal
/// frame. Combed fur has one main direction, and boxes that are aligned to this direction are much smaller. A
/// ray is rotated once for the whole tree. The frame does not affect curves or hits.
struct FurFrame {
  std::array<V3f, 3> axes{V3f(1, 0, 0), V3f(0, 1, 0), V3f(0, 0, 1)};
  bool turned = false;  ///< false: exactly the axes of the grid

  V3f operator()(const V3f& p) const { return {axes[0].dot(p), axes[1].dot(p), axes[2].dot(p)}; }
  SnappedSegment operator()(const SnappedSegment& segment) const;
  /// Returns a box along the axes of the grid that contains `box`, which is aligned to this frame.
  FurBox unrotated(const FurBox& box) const;
  /// Whether both frames have the same axes. All frames that are not turned are equal.
  bool operator==(const FurFrame& o) const { return turned == o.turned && (!turned || axes == o.axes); }
  /// Whether the axes are orthonormal, up to an error of 0.001. For checking data from a file.
  bool is_possible() const;
};

/// When a tree uses a rotated frame. Trees over moving strands never do: they use the axes of the grid.
enum class FurRotation : uint8_t {
  kNever,
  /// If rotation reduces the total area of the boxes of single segments to less than 0.7 of its value. The
  /// boxes of four segments then shrink noticeably, too.
  kWhenUseful,
  kAlways,  ///< for tests
};

/// Returns the frame for a tree over `strands`, estimated from a few hundred segments. One axis of a rotated
/// frame is the common direction of these segments. The other two axes are the pair, out of several, for
/// which the boxes are smallest. Deterministic.
FurFrame choose_frame(const SnappedStrands& strands, FurRotation rotation);

}  // namespace pelage
