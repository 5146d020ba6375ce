// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/vector.h"
#include "render/frame/frame_geometry.h"

namespace pelage {

/// The chunk of fur in which a strand is stored.
struct ChunkWhy {
  uint32_t index = 0;              ///< among all chunks of the frame
  size_t strands = 0;              ///< strands of the chunk
  size_t bytes = 0;                ///< memory of the chunk
  Box3f box;                       ///< contains the chunk while the shutter is open; world space
  size_t segment_cell_bounds = 0;  ///< count of boxes of cells of segments; 0 if it has none
  uint32_t growths = 0;  ///< how often it grew for this frame; 0 if it was kept from an earlier frame
};

/// Explains a chunk of fur. Grows it if it is not in memory.
ChunkWhy explain_chunk(const FrameGeometry& geometry, uint32_t chunk);

}  // namespace pelage
