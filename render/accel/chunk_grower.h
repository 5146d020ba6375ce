// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "geom/strand_scale.h"
#include "geom/strands.h"
#include "geom/tessellation.h"

namespace pelage {

/// Strands and how opaque they are.
struct FurContents {
  Strands strands;
  std::vector<float> opacity;  ///< one in [0, 1] per point, or empty: opaque
};

/// What a chunk holds: fur of one part, or one skin.
struct ChunkContents {
  std::variant<FurContents, SkinMesh> geometry;
  uint32_t part = 0;  ///< which coat of which character, or which skin; strand ids are unique within one
};

/// How large the contents of a chunk are at most.
struct ChunkCounts {
  size_t strands = 0;
  size_t points = 0;  ///< of one motion key
  size_t segments = 0;
  size_t attribute_floats = 0;  ///< of all attributes together
  size_t vertices = 0;          ///< of one motion key
  size_t triangles = 0;
  int motion_keys = 1;
  size_t growth_bytes = 0;  ///< what growing holds beside the contents, dropped when it is done
};

/// The chunks of a frame by number: what each holds, how much that is and how to make it, whatever makes it.
/// Thread safety: all members may be called from many threads at once.
class ChunkGrower {
 public:
  virtual ~ChunkGrower() = default;
  /// Same chunk, same contents. By the calling thread alone; may throw.
  virtual ChunkContents grow(uint32_t chunk) const = 0;
  /// Whether grow() gives a skin, not fur. Counts do not tell: a skin of holes has no vertices.
  virtual bool is_skin(uint32_t chunk) const = 0;
  /// ChunkContents::part, without growing.
  virtual uint32_t part(uint32_t chunk) const = 0;
  /// Upper bounds, without growing.
  virtual ChunkCounts counts(uint32_t chunk) const = 0;
  /// For messages: what the chunk is a part of, or nothing.
  virtual std::string name(uint32_t) const { return {}; }
  /// Of fur, without growing.
  virtual StrandScale scale(uint32_t chunk) const = 0;
};

}  // namespace pelage
