// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "procedurals/bounds/procedural.h"
#include "rib/scene/rib_batches.h"

namespace pelage {

/// A procedural that a transform places in the world. Its strands have as many motion keys as the strands of
/// the other procedural or as the transform has times, whichever is more. Widths are scaled by the cube root
/// of the transform's determinant, as in to_world().
class PlacedProcedural final : public Procedural {
 public:
  /// `shutter`: the time between the first and the last motion key of the strands of `inner`.
  PlacedProcedural(std::unique_ptr<Procedural> inner, RibTransform placement, const RibShutter& shutter);

  Box3f bound(BoundSpan span) const override;
  std::vector<std::unique_ptr<Procedural>> split() const override;
  Strands generate() const override;
  StrandCounts counts() const override;
  StrandScale scale() const override;
  size_t temporary_bytes() const override;
  ChunkBounds exact_bounds(BoundSpan span, int keys) const override;
  size_t bytes() const override { return sizeof(*this) + inner_->bytes(); }

 private:
  const std::unique_ptr<Procedural> inner_;
  const std::shared_ptr<const RibTransform> placement_;  // shared by all parts of a coat
  const RibShutter shutter_;

  PlacedProcedural(std::unique_ptr<Procedural> inner, std::shared_ptr<const RibTransform> placement,
                   const RibShutter& shutter);
};

/// Returns the size of things of size 1 after a transform: the cube root of its determinant.
float mean_scale(const M44f& matrix);

}  // namespace pelage
