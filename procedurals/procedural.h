// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "base/hash.h"
#include "base/vector.h"
#include "geom/strand_counts.h"
#include "geom/strand_scale.h"
#include "geom/strands.h"
#include "procedurals/chunk_bounds.h"

namespace pelage {

class ContentStore;

/// During which time a bound holds. A procedural that does not know the shutter must hold the whole interval
/// of its frame, [frame - 1/2, frame + 1/2]. With a closed shutter both are the same instant.
enum class BoundSpan { kFrame, kShutter };

/// Where the exact boxes of a chunk are remembered from run to run: entry `index` of the `count` under one
/// key.
struct BoundsRecord {
  std::shared_ptr<const ContentStore> store;
  ContentHash key;  ///< of everything that the boxes of all entries depend on, but for span and keys
  size_t index = 0;
  size_t count = 0;
};

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
  /// Of the coat: the same for all that it splits into.
  virtual StrandScale scale() const = 0;
  /// What generate() holds beside what it gives and what growing any leaf takes.
  virtual size_t temporary_bytes() const { return 0; }
  /// Exact boxes of the parts of a leaf over the span (two-pass bounding): grows everything, measures and
  /// drops it. `keys` is 1, or 2 for boxes linear in time over the shutter.
  virtual ChunkBounds exact_bounds(BoundSpan span, int keys) const = 0;
  /// Names what generate() gives: equal names, equal strands, in any run of this program. Nothing where
  /// nobody knows one.
  virtual std::optional<ContentHash> content() const { return {}; }
  /// Nothing where they are not remembered.
  virtual std::optional<BoundsRecord> bounds_record() const { return {}; }
  /// What it holds itself, on the heap: a frame has hundreds of thousands.
  virtual size_t bytes() const { return 0; }
};

}  // namespace pelage
