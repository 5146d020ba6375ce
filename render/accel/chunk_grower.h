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

/// Strands with their opacity.
struct FurContents {
  Strands strands;
  std::vector<float> opacity;  ///< one value in [0, 1] per point; empty if all strands are opaque
};

/// Contents of a chunk: fur of one part, or one skin.
struct ChunkContents {
  std::variant<FurContents, SkinMesh> geometry;
  uint32_t part = 0;  ///< index of the coat or skin; strand ids are unique within a part
};

/// Upper bounds of the size of a chunk's contents.
struct ChunkCounts {
  size_t strands = 0;
  size_t points = 0;  ///< of one motion key
  size_t segments = 0;
  size_t attribute_floats = 0;  ///< number of floats of all attributes together
  size_t vertices = 0;          ///< of one motion key
  size_t triangles = 0;
  int motion_keys = 1;
  size_t growth_bytes = 0;  ///< temporary memory of grow(), without the contents
};

/// Makes the contents of the numbered chunks of a frame, and gives upper bounds of their size in advance. An
/// interface, so that contents may come from any source. Thread safety: all members may be called from many
/// threads at once.
class ChunkGrower {
 public:
  virtual ~ChunkGrower() = default;
  /// Makes the contents of a chunk, which are the same at every call. Runs on the calling thread only; may
  /// throw.
  virtual ChunkContents grow(uint32_t chunk) const = 0;
  /// Whether the chunk is a skin rather than fur. The counts do not show this: a skin that consists of holes
  /// has no vertices.
  virtual bool is_skin(uint32_t chunk) const = 0;
  /// Returns ChunkContents::part of a chunk without growing the chunk.
  virtual uint32_t part(uint32_t chunk) const = 0;
  /// Returns upper bounds of the size of a chunk's contents without growing the chunk.
  virtual ChunkCounts counts(uint32_t chunk) const = 0;
  /// Name of the coat or skin for messages; may be empty.
  virtual std::string name(uint32_t) const { return {}; }
  /// Returns the scale of the strands of a fur chunk without growing the chunk.
  virtual StrandScale scale(uint32_t chunk) const = 0;
};

}  // namespace pelage
