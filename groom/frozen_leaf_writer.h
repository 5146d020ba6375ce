// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "groom/frozen_leaf.h"

namespace pelage {

/// Collects the batches of a leaf, in rest space after the frozen operators, and chooses the most compact
/// form that holds them.
class FrozenLeafWriter {
 public:
  void add(const StrandBatch& batch);
  /// The bytes that FrozenLeaf reads: the same for the same strands, on any machine of one byte order.
  std::vector<std::byte> finish() const;

 private:
  struct Block {
    size_t count = 0, points = 0;
    std::vector<float> shape;   // [point][axis][strand], in the follicle frame
    std::vector<float> radius;  // [point][strand]
    std::vector<float> color;   // [row][channel][strand]
    std::vector<float> clump;   // [strand]
    bool clumped = false;       // some number is not that of a strand in no clump
  };
  /// A quantity of every strand as a profile times a factor of the strand's own, if it is that.
  struct Profile {
    FrozenClass kind = FrozenClass::kNone;
    std::vector<float> profile;  // of the largest strand, the largest value 1
    float step = 0;              // what 1 of 65535 measures
  };
  static Profile profile_of(const std::vector<Block>& blocks, std::vector<float> Block::*values,
                            float untouched);
  bool needs_floats() const;
  void write_shapes(const Block& block, const FrozenLeaf& form, std::byte* out) const;

  std::vector<Block> blocks_;
};

}  // namespace pelage
