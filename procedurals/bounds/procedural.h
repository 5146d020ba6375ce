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
#include "procedurals/bounds/chunk_bounds.h"

namespace pelage {

class ContentStore;

/// Time span for which a bound is valid. kFrame: the frame interval [frame - 1/2, frame + 1/2]. kShutter:
/// from shutter open to close. A procedural that does not know the shutter must return bounds for kFrame in
/// both cases. If the shutter opens and closes at the same time, both spans are this instant.
enum class BoundSpan { kFrame, kShutter };

/// Location of the exact boxes of a chunk that are stored between runs. The boxes of `count` chunks are
/// stored together in one file of `store`; this chunk has the index `index`.
struct BoundsRecord {
  std::shared_ptr<const ContentStore> store;
  ContentHash key;  ///< hash of everything on which the boxes of all these chunks depend, except `span` and
                    ///< `keys` of exact_bounds()
  size_t index = 0;
  size_t count = 0;
};

/// Strands that are made on demand. As with RiProcedural of RenderMan [RISPEC 3.2, procedural primitives],
/// there are three steps: bound(), split() and generate(). World space. Every call of generate() returns the
/// same strands, bit by bit.
///
/// Thread safety: all members may be called from many threads at once.
class Procedural {
 public:
  virtual ~Procedural() = default;
  /// Returns a box that contains all strands of generate(), with their radii, during the span (law 4). Does
  /// not grow strands.
  virtual Box3f bound(BoundSpan span) const = 0;
  /// Returns smaller procedurals that together replace this one. Returns none for a leaf.
  virtual std::vector<std::unique_ptr<Procedural>> split() const { return {}; }
  /// Returns the strands of a leaf, with motion keys from shutter open to close.
  virtual Strands generate() const = 0;
  /// Returns the size of the result of generate(), or an upper bound of it.
  virtual StrandCounts counts() const = 0;
  /// Returns the scale of the coat. It is the same for this procedural and all those that split() returns.
  virtual StrandScale scale() const = 0;
  /// Returns additional temporary memory of generate(), in bytes: without its result, and without the memory
  /// that growing any leaf with the same counts() needs.
  virtual size_t temporary_bytes() const { return 0; }
  /// Returns the exact boxes of the parts of a leaf during the span. Grows all strands of the leaf, measures
  /// them, and discards them. `keys`: 1 for boxes that are constant in time, 2 for boxes that are linear in
  /// time from shutter open to close.
  virtual ChunkBounds exact_bounds(BoundSpan span, int keys) const = 0;
  /// Returns a hash that identifies the result of generate(): equal hashes mean equal strands, in all runs of
  /// this build of the program. Empty when unknown.
  virtual std::optional<ContentHash> content() const { return {}; }
  /// Returns the location where the exact boxes of this leaf are stored; empty if they are not stored.
  virtual std::optional<BoundsRecord> bounds_record() const { return {}; }
  /// Returns the heap memory that this object takes, including the object itself, because a frame may have
  /// hundreds of thousands of procedurals.
  virtual size_t bytes() const { return 0; }
};

}  // namespace pelage
