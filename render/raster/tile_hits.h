// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/accel/chunk_geometry.h"
#include "render/frame/camera_samples.h"
#include "render/raster/tile_lines.h"

namespace pelage {

/// The hits of the camera rays of a tile with the segments that drawing found. Rays that see the same segment
/// are tested together.
class TileHits {
 public:
  /// The samples of a tile that see the same segment.
  struct Group {
    uint32_t chunk = 0, segment = 0;
    uint32_t first = 0, count = 0;  ///< their slots, as a range of members_
    Hit hit;                        ///< a hit with the segment, if any sample has one
  };

  /// Forgets all hits. Calls is_fur(chunk) to find which lines see a segment; the others get no hit.
  template <class IsFur>
  void begin(const TileLines& lines, const IsFur& is_fur) {
    start(lines.size());
    for (size_t slot = 0; slot < lines.size(); ++slot) {
      const TileWinner winner = lines.winner(slot);
      if (winner.chunk < TileWinner::kTraced && is_fur(winner.chunk)) add(winner, slot);
    }
    sort();
  }
  /// Returns the groups with the same chunk, from index `first` on; empty at the end.
  std::span<Group> chunk(size_t first);
  /// Finds the hits of the samples of a group. `samples`: by slot.
  void find(const ChunkGeometry& geometry, Group& group, std::span<const CameraSample> samples);

  /// Returns the hit of a sample; empty if its ray misses the segment that was drawn.
  Hit hit(size_t slot) const;
  /// Returns the max memory for this count of samples, in bytes.
  static size_t bytes(size_t samples) {
    return samples * (sizeof(Place) + sizeof(Group) + 2 * sizeof(uint32_t)) +
           table_size(samples) * sizeof(uint32_t);
  }

 private:
  static constexpr uint32_t kNone = ~0u;
  /// Where a sample hits its segment.
  struct Place {
    uint32_t group = kNone;
    float distance = 0, u = 0, v = 0;
  };
  static size_t table_size(size_t samples) { return 2 * std::bit_ceil(samples + 1); }
  void start(size_t samples);
  void add(const TileWinner& winner, size_t slot);
  void sort();

  std::vector<Place> places_;  // by slot
  std::vector<Group> groups_;
  std::vector<uint32_t> members_;
  std::vector<uint32_t> table_;  // hash table of groups
  std::vector<uint32_t> ranks_;  // by number of a group as it was added
};

}  // namespace pelage
