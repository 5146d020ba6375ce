// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "base/vector.h"
#include "geom/strand_counts.h"
#include "geom/strands.h"

namespace pelage {

/// During which time a bound holds. A procedural that does not know the shutter must hold the whole interval
/// of its frame, [frame - 1/2, frame + 1/2]. With a closed shutter both are the same instant.
enum class BoundSpan { kFrame, kShutter };

/// Geometry that exists only while something needs it: bound, split, generate, as RenderMan's RiProcedural
/// [RISPEC 3.2, procedural primitives]. World space.
///
/// Thread safety: all members may be called from many threads at once. Same procedural, same bytes.
class Procedural {
 public:
  virtual ~Procedural() = default;
  /// Holds every point +- radius of everything that generate() may give, over the span (law 4). No strand is
  /// grown.
  virtual Box3f bound(BoundSpan span) const = 0;
  /// Finer procedurals to use instead; empty for a leaf.
  virtual std::vector<std::unique_ptr<Procedural>> split() const { return {}; }
  /// The strands of a leaf, over the shutter.
  virtual Strands generate() const = 0;
  /// How much generate() gives: exactly, or an upper bound.
  virtual StrandCounts counts() const = 0;
};

}  // namespace pelage
