// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "base/hash.h"
#include "render/accel/strand_handle.h"

namespace pelage {

/// What the gather points of a strand depend on. The same for all hits on the strand.
struct StrandGatherPoints {
  float length = 0;       ///< of the control polygon in the picture when the shutter opens, in pixels
  int level = 0;          ///< the strand has 2^level + 1 gather points
  bool in_cells = false;  ///< whether its hits are assigned to the cells of the coat instead
  uint64_t patch = 0;     ///< CoatCells::patch()
};

/// Keeps the StrandGatherPoints of the strands that a thread looked up last, because samples of neighbouring
/// pixels often see the same strands. Belongs to one frame.
class RecentGatherPoints {
 public:
  /// Returns the gather points of a strand. Calls make() if they are not kept.
  template <class Make>
  const StrandGatherPoints& of(const StrandKey& strand, const Make& make) {
    Kept& kept = kept_[hash64(strand.part, strand.id) % kCount];
    if (!kept.is_used || kept.strand != strand) kept = {strand, make(), true};
    return kept.gather_points;
  }
  static constexpr size_t bytes() { return kCount * sizeof(Kept); }

 private:
  static constexpr size_t kCount = 1024;
  struct Kept {
    StrandKey strand;
    StrandGatherPoints gather_points;
    bool is_used = false;
  };

  std::vector<Kept> kept_ = std::vector<Kept>(kCount);
};

}  // namespace pelage
