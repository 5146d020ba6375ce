// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "procedurals/bounds/procedural.h"

namespace pelage {

/// Strands in memory, as a procedural that is a single leaf. The renderer copies the strands while they are a
/// chunk. A chunk should have at most 8,000 strands; make several procedurals for more.
class FixedStrands final : public Procedural {
 public:
  /// Coordinates are rounded as the widest strand allows.
  explicit FixedStrands(Strands strands);
  FixedStrands(std::shared_ptr<const Strands> strands, const StrandScale& scale);

  Box3f bound(BoundSpan span) const override;
  Strands generate() const override { return *strands_; }
  StrandCounts counts() const override { return counts_of(*strands_); }
  StrandScale scale() const override { return scale_; }
  ChunkBounds exact_bounds(BoundSpan span, int keys) const override;
  size_t bytes() const override { return sizeof(*this); }

 private:
  std::shared_ptr<const Strands> strands_;
  StrandScale scale_;
};

}  // namespace pelage
