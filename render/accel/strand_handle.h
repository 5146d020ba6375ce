// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>

namespace pelage {

/// Where a strand is stored: its chunk, and its index in that chunk. A handle identifies the same strand for
/// any number of threads and any memory limit, even after its chunk was dropped and grown again. The frame
/// must be divided into the same chunks and traced by the same kind of accelerator. The division may depend
/// on `render.memory`, so no random number and no result may depend on a handle: use a StrandKey for these.
struct StrandHandle {
  static constexpr uint32_t kNone = ~0u;

  uint32_t chunk = kNone;  ///< kNone: no strand of a chunk
  uint32_t index = 0;      ///< below ChunkGeometry::strand_count()

  explicit operator bool() const { return chunk != kNone; }
  friend auto operator<=>(const StrandHandle&, const StrandHandle&) = default;
};

/// Identifies a strand within its frame, however the frame is divided into chunks.
struct StrandKey {
  uint32_t part = 0;  ///< index of the coat in the frame
  uint64_t id = 0;    ///< within the part

  friend auto operator<=>(const StrandKey&, const StrandKey&) = default;
};

}  // namespace pelage
