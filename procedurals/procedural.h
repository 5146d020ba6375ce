// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "base/vector.h"
#include "geom/strands.h"

namespace pelage {

/// Geometry that exists only while something needs it: bound, split, generate, as RenderMan's RiProcedural
/// [RISPEC 3.2, procedural primitives]. World space.
///
/// Thread safety: all members may be called from many threads at once. Same procedural, same bytes.
class Procedural {
 public:
  virtual ~Procedural() = default;
  /// Holds every point +- radius of everything that generate() may give, over the whole shutter (law 4).
  virtual Box3f bound() const = 0;
  /// Finer procedurals to use instead; empty for a leaf.
  virtual std::vector<std::unique_ptr<Procedural>> split() const { return {}; }
  /// The strands of a leaf.
  virtual Strands generate() const = 0;
};

}  // namespace pelage
