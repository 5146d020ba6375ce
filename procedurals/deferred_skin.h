// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "base/vector.h"
#include "geom/tessellation.h"
#include "procedurals/procedural.h"

namespace pelage {

/// A skin whose triangles exist only while something needs them. World space.
///
/// Thread safety: all members may be called from many threads at once. Same skin, same view, same bytes.
class DeferredSkin {
 public:
  virtual ~DeferredSkin() = default;
  /// Holds every triangle over the span.
  virtual Box3f bound(BoundSpan span) const = 0;
  /// Poses of tessellate(), at even times over the shutter.
  virtual int motion_keys() const = 0;
  /// Exactly how much tessellate() will give.
  virtual TessellationSize size(const View& view) const = 0;
  virtual SkinMesh tessellate(const View& view) const = 0;
  /// What tessellate() holds beside what it gives, but for what is charged already.
  virtual size_t making_bytes() const = 0;
};

}  // namespace pelage
