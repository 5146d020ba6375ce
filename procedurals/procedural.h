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

/// Time span for which a bound holds. A procedural that does not know the shutter must bound the whole
/// interval of its frame, [frame - 1/2, frame + 1/2]. With a closed shutter, kFrame and kShutter
/// are the same instant.
enum class BoundSpan { kFrame, kShutter };

/// Where the exact boxes of a chunk are stored between runs: entry `index` of the `count` entries with one
/// key.
struct BoundsRecord {
  std::shared_ptr<const ContentStore> store;
  ContentHash key;  ///< hash of everything that the boxes of all entries depend on, except `span` and `keys`
                    ///< of exact_bounds()
  size_t index = 0;
  size_t count = 0;
};

/// Geometry that is made on demand, in the steps bound, split and generate, like RenderMan's RiProcedural
/// [RISPEC 3.2, procedural primitives]. World space.
///
/// Thread safety: all members may be called from many threads at once. The same procedural always generates
/// the same bytes.
class Procedural {
 public:
  virtual ~Procedural() = default;
  /// A box that contains every point +- radius that generate() can return, over the span (law 4). Does not
  /// grow strands.
  virtual Box3f bound(BoundSpan span) const = 0;
  /// Smaller procedurals that replace this one; empty for a leaf.
  virtual std::vector<std::unique_ptr<Procedural>> split() const { return {}; }
  /// The strands of a leaf, over the shutter.
  virtual Strands generate() const = 0;
  /// Size of the result of generate(): exact, or an upper bound.
  virtual StrandCounts counts() const = 0;
  /// Scale of the coat; the same for all procedurals that this one is split into.
  virtual StrandScale scale() const = 0;
  /// Temporary memory of generate() that is neither its result nor the memory that growing any leaf with this
  /// number of strands needs.
  virtual size_t temporary_bytes() const { return 0; }
  /// Exact boxes of the parts of a leaf over the span (two-pass bounding): grows everything, measures and
  /// discards it. `keys`: 1, or 2 for boxes linear in time over the shutter.
  virtual ChunkBounds exact_bounds(BoundSpan span, int keys) const = 0;
  /// Identifies the result of generate(): equal hashes mean equal strands, in any run of this program. Empty
  /// when unknown.
  virtual std::optional<ContentHash> content() const { return {}; }
  /// Where the exact boxes of this leaf are stored; empty if they are not stored.
  virtual std::optional<BoundsRecord> bounds_record() const { return {}; }
  /// Heap memory of this object. A frame has hundreds of thousands of procedurals.
  virtual size_t bytes() const { return 0; }
};

}  // namespace pelage
