// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "geom/strands.h"
#include "rib/syntax/rib_transform.h"

namespace pelage {

/// Times at which geometry is needed: evenly spaced from shutter open to close, in the unit of the file's
/// motion blocks.
struct RibShutter {
  V2f times{0, 0};
  /// Returns the times for geometry with `samples` samples; the opening time alone if it does not move or the
  /// shutter opens and closes at the same time.
  std::vector<double> keys(size_t samples) const;
};

/// Returns the strands in world space at the times of the shutter. `strands`: in the space of `to_world`,
/// with a motion key at each of `times` (one key: not moving). Radii are scaled by the cube root of the
/// transform's determinant. Drops strands with a position that is not finite or beyond 1e18 in size, and
/// strands without extent; replaces other values that are not finite by 0.
StrandArrays to_world(StrandArrays strands, const std::vector<double>& times, const RibTransform& to_world,
                      const RibShutter& shutter, size_t& dropped);

/// Divides the strands of coats into batches of at most kMaxStrands strands, in the order of the file. The
/// strands of a batch have the same basis, motion keys and attributes.
class RibBatches {
 public:
  static constexpr size_t kMaxStrands = 8000;
  using Take = std::function<void(size_t coat, Strands batch)>;

  /// `take`: receives each complete batch.
  explicit RibBatches(Take take) : take_(std::move(take)) {}

  void add(size_t coat, const StrandArrays& strands);
  /// Passes on the batches that are not full, in the order in which they were begun.
  void finish();

 private:
  struct Open {
    size_t coat;
    StrandArrays arrays;
    std::vector<std::vector<float>> keys;  // points of each motion key
  };
  Open& open_for(size_t coat, const StrandArrays& strands);
  void append(Open& open, const StrandArrays& from, size_t begin, size_t end);
  void pass_on(Open& open);

  Take take_;
  std::vector<Open> open_;
};

}  // namespace pelage
