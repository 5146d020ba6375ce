// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "geom/limit_surface.h"
#include "groom/follicles.h"
#include "groom/imported.h"
#include "groom/operator.h"
#include "groom/strand_batch.h"

namespace pelage {

/// Roots of the strands of a groom, and their shape before the first operator: straight strands on follicles,
/// or the strands of a file. Immutable once made. Thread safety: const members may be called from any thread.
struct CoatSource {
  std::shared_ptr<const LimitSurface> rest;  ///< null: strands without a skin
  int points = 8;                            ///< number of points of a strand that is not imported
  FollicleTree grown;                        ///< follicles of strands that are not imported
  std::optional<ImportedStrands> imported;

  const FollicleTree& follicles() const { return imported ? imported->follicles() : grown; }
  int strand_points(size_t follicle) const { return imported ? imported->strand_points(follicle) : points; }
  /// Number of follicles from `begin`, up to `end` at most, that make one batch.
  size_t run_length(size_t begin, size_t end) const {
    return imported ? imported->run_length(begin, end) : std::min(kBlockStrands, end - begin);
  }
  /// Fills rest roots, ids and texture coordinates of batch.count strands.
  void place(StrandBatch& batch, size_t begin) const;
  /// The same, and also creates the points that the first operator sees.
  void start(StrandBatch& batch, size_t begin) const;
  /// Properties of the strands of a leaf before the first operator.
  StrandReach reach(size_t leaf) const;
  size_t bytes() const { return imported ? imported->bytes() : grown.bytes(); }
};

}  // namespace pelage
