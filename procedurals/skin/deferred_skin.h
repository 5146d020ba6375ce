// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/hash.h"
#include "base/vector.h"
#include "geom/skin_pieces.h"
#include "geom/surface_motion.h"
#include "geom/view.h"
#include "procedurals/bounds/procedural.h"

namespace pelage {

/// A skin whose triangles are made on demand. The skin is divided into pieces, which are groups of faces.
/// World space. The same skin and view always give the same triangles, bit by bit.
///
/// Thread safety: all members may be called from many threads at once.
class DeferredSkin {
 public:
  virtual ~DeferredSkin() = default;
  /// Divides the skin into pieces that cost at most `max_cost` each. A piece may cost more if it is a single
  /// face or would be too small (see divide_skin()). Throws Error (kStopped) when the job is stopped.
  virtual std::vector<SkinPiece> divide(const View& view, size_t max_cost, const Job& job) const = 0;
  /// Returns a box that contains every triangle of a piece during the time span.
  virtual Box3f bound(const SkinPiece& piece, BoundSpan span) const = 0;
  /// Returns the number of motion keys of tessellate(): poses at evenly spaced times from shutter open to
  /// close.
  virtual int motion_keys() const = 0;
  /// Returns the triangles of a piece. They do not depend on how the skin is divided into pieces.
  virtual SkinMesh tessellate(const SkinPiece& piece, const View& view) const = 0;
  /// Returns the max temporary memory of tessellate() in bytes, without its result and without memory that is
  /// already charged to the ledger.
  virtual size_t temporary_bytes(const SkinPiece& piece) const = 0;
  /// Returns how the skin moves from the frame to the next one, near a point of one of its faces. `place`:
  /// null for strands that follow the character but grow on no skin. Empty if nothing moves, or if only the
  /// motion keys are known.
  virtual std::optional<SurfaceStep> step(const RootAddress* /*place*/) const { return {}; }
  /// Returns the approximate unit normal at a point of a face when the shutter opens. Empty when unknown.
  virtual std::optional<V3f> normal(const RootAddress& /*place*/) const { return {}; }
  /// Hash of everything on which pieces and triangles depend, except for the view. Empty when unknown.
  virtual std::optional<ContentHash> content() const { return {}; }
  /// Number of faces. All indices in SkinMesh::faces are smaller.
  virtual uint32_t face_count() const = 0;
};

}  // namespace pelage
