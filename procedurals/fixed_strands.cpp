// SPDX-License-Identifier: Apache-2.0
#include "procedurals/fixed_strands.h"

#include <algorithm>

#include "geom/curve_bounds.h"
#include "procedurals/bounds/segment_parts.h"

namespace pelage {
namespace {

StrandScale scale_of(const Strands& strands) {
  float radius = 0;
  for (size_t i = 0; i < strands.point_count(); ++i) radius = std::max(radius, strands.radius(i));
  return {2 * radius, strands.point_count() > 0 ? strands.point(0) : V3f(0), 2 * radius};
}

}  // namespace

FixedStrands::FixedStrands(Strands strands)
    : strands_(std::make_shared<const Strands>(std::move(strands))), scale_(scale_of(*strands_)) {}
FixedStrands::FixedStrands(std::shared_ptr<const Strands> strands, const StrandScale& scale)
    : strands_(std::move(strands)), scale_(scale) {}

Box3f FixedStrands::bound(BoundSpan) const { return pelage::exact_bounds(*strands_); }
ChunkBounds FixedStrands::exact_bounds(BoundSpan, int keys) const {
  return SegmentParts(*strands_).exact_bounds(keys);
}

}  // namespace pelage
