// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "base/vector.h"
#include "geom/skin_pieces.h"
#include "geom/view.h"
#include "procedurals/procedural.h"

namespace pelage {

/// A skin whose triangles are made on demand, piece by piece. World space.
///
/// Thread safety: all members may be called from many threads at once. Same skin, same view, same bytes.
class DeferredSkin {
 public:
  virtual ~DeferredSkin() = default;
  /// Divides the skin into pieces that cost at most `max_cost` each, if the faces allow it (divide_skin).
  /// Throws Error (kStopped).
  virtual std::vector<SkinPiece> divide(const View& view, size_t max_cost, const Job& job) const = 0;
  /// A box that contains every triangle of a piece over the span.
  virtual Box3f bound(const SkinPiece& piece, BoundSpan span) const = 0;
  /// Number of poses of tessellate(), at evenly spaced times over the shutter.
  virtual int motion_keys() const = 0;
  /// The triangles of a piece, independent of how the skin is divided.
  virtual SkinMesh tessellate(const SkinPiece& piece, const View& view) const = 0;
  /// Max temporary memory of tessellate(), without its result and without memory that is already charged.
  virtual size_t temporary_bytes(const SkinPiece& piece) const = 0;
};

}  // namespace pelage
