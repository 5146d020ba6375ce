// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>

namespace pelage {

/// Where a strand is stored: its chunk, and its index in that chunk. A handle still identifies the same
/// strand after the chunk was evicted and grown again. Two runs give a strand the same handle if they divide
/// the frame into the same chunks and trace it with the same kind of accelerator, whatever the number of
/// threads. The division into chunks may depend on `render.memory`. Random numbers and results must therefore
/// not depend on a handle: use a StrandKey for them.
struct StrandHandle {
  static constexpr uint32_t kNone = ~0u;

  uint32_t chunk = kNone;  ///< kNone: the handle is empty
  uint32_t index = 0;      ///< below ChunkGeometry::strand_count()

  explicit operator bool() const { return chunk != kNone; }
  friend auto operator<=>(const StrandHandle&, const StrandHandle&) = default;
};

/// Identifies a strand within its frame. The key does not depend on how the frame is divided into chunks.
struct StrandKey {
  uint32_t part = 0;  ///< index of the coat in the frame
  uint64_t id = 0;    ///< unique within the part

  friend auto operator<=>(const StrandKey&, const StrandKey&) = default;
};

}  // namespace pelage
