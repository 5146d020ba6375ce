// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "geom/limit_surface.h"
#include "groom/coat/imported.h"
#include "groom/follicles/follicles.h"
#include "groom/operators/operator.h"
#include "groom/strands/strand_batch.h"

namespace pelage {

/// The strands of a groom before the first operator: straight strands on follicles, or the strands of a file.
/// Immutable once made. Thread safety: const members may be called from any thread.
struct CoatSource {
  std::shared_ptr<const LimitSurface> rest;   ///< rest skin; null for strands without a skin
  int points = 8;                             ///< number of points of a strand that is not imported
  std::shared_ptr<const FollicleTree> grown;  ///< follicles of strands that are not imported
  std::optional<ImportedStrands> imported;    ///< strands of a file; empty when all strands are grown

  const FollicleTree& follicles() const { return imported ? imported->follicles() : *grown; }
  int strand_points(size_t follicle) const { return imported ? imported->strand_points(follicle) : points; }
  /// Returns the number of follicles from `begin` on, at most up to `end`, that form one batch.
  size_t run_length(size_t begin, size_t end) const {
    return imported ? imported->run_length(begin, end) : std::min(kBlockStrands, end - begin);
  }
  /// Sets the rest roots, ids and texture coordinates of the strands of a batch: batch.count follicles from
  /// `begin` on.
  void place(StrandBatch& batch, size_t begin) const;
  /// Does the same as place(), and also makes the points that the first operator receives.
  void start(StrandBatch& batch, size_t begin) const;
  /// Returns bounds of the strands of a leaf before the first operator.
  StrandReach reach(size_t leaf) const;
  size_t bytes() const { return imported ? imported->bytes() : grown->bytes(); }
};

}  // namespace pelage
