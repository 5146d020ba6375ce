// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>

namespace pelage {

/// Where a strand is held: in which chunk, and which of its strands it is. A handle names the same strand for
/// any number of threads and any memory limit, and when its chunk was dropped and grown again, as long as the
/// frame is divided into the same chunks and traced by the same kind of accelerator. The division itself may
/// follow `render.memory`: no random number and no result may depend on a handle. That is what a StrandKey is
/// for.
struct StrandHandle {
  static constexpr uint32_t kNone = ~0u;

  uint32_t chunk = kNone;  ///< kNone: no strand of a chunk
  uint32_t index = 0;      ///< below ChunkGeometry::strand_count()

  explicit operator bool() const { return chunk != kNone; }
  friend auto operator<=>(const StrandHandle&, const StrandHandle&) = default;
};

/// What a strand is called in its frame, however that is divided.
struct StrandKey {
  uint32_t part = 0;  ///< which coat of which character
  uint64_t id = 0;    ///< within the part

  friend auto operator<=>(const StrandKey&, const StrandKey&) = default;
};

}  // namespace pelage
