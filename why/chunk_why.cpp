// SPDX-License-Identifier: Apache-2.0
#include "why/chunk_why.h"

#include "render/accel/flush_denormals.h"

namespace pelage {

ChunkWhy explain_chunk(const FrameGeometry& geometry, uint32_t chunk) {
  const FlushDenormals flush;
  const ResidentChunks& chunks = geometry.chunks();
  ChunkWhy why;
  why.index = chunk;
  chunks.visit(chunk, 0, [&](const ChunkGeometry& content) {
    why.strands = content.strand_count();
    why.bytes = content.bytes();
    return 0;
  });
  why.box = chunks.boxes().whole(chunk);
  why.segment_cell_bounds = chunks.boxes().fine(chunk).count();
  why.growths = geometry.growths(chunk);
  return why;
}

}  // namespace pelage
