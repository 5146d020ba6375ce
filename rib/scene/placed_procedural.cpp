// SPDX-License-Identifier: Apache-2.0
#include "rib/scene/placed_procedural.h"

#include <algorithm>
#include <cmath>

#include "procedurals/bounds/segment_parts.h"

namespace pelage {

float mean_scale(const M44f& matrix) { return std::cbrt(std::abs(matrix.determinant())); }

PlacedProcedural::PlacedProcedural(std::unique_ptr<Procedural> inner, RibTransform placement,
                                   const RibShutter& shutter)
    : PlacedProcedural(std::move(inner), std::make_shared<const RibTransform>(std::move(placement)),
                       shutter) {}

PlacedProcedural::PlacedProcedural(std::unique_ptr<Procedural> inner,
                                   std::shared_ptr<const RibTransform> placement, const RibShutter& shutter)
    : inner_(std::move(inner)), placement_(std::move(placement)), shutter_(shutter) {}

// Between two times of the transform, a point moves on a straight line, so the boxes at these times contain
// it. A fibre keeps its circular cross-section, which may be wider than the transformed box in a direction in
// which the transform shrinks.
Box3f PlacedProcedural::bound(BoundSpan span) const {
  const Box3f inner = inner_->bound(span);
  Box3f box;
  if (inner.isEmpty()) return box;
  const V3f size = inner.size();
  const float max_radius = 0.5f * std::min({size.x, size.y, size.z});
  float radius = 0;
  for (const auto& [time, matrix] : placement_->samples()) {
    for (int corner = 0; corner < 8; ++corner) {
      const V3f p(corner & 1 ? inner.max.x : inner.min.x, corner & 2 ? inner.max.y : inner.min.y,
                  corner & 4 ? inner.max.z : inner.min.z);
      box.extendBy(p * matrix);
    }
    radius = std::max(radius, mean_scale(matrix) * max_radius);
  }
  // 2^-20 of the largest coordinate: the rounding of these products and of those of the points.
  const float largest = std::max({std::abs(box.min.x), std::abs(box.min.y), std::abs(box.min.z),
                                  std::abs(box.max.x), std::abs(box.max.y), std::abs(box.max.z)});
  const V3f slack(radius + 0x1p-20f * largest);
  return Box3f(box.min - slack, box.max + slack);
}

std::vector<std::unique_ptr<Procedural>> PlacedProcedural::split() const {
  std::vector<std::unique_ptr<Procedural>> parts;
  for (auto& part : inner_->split())
    parts.push_back(std::unique_ptr<Procedural>(new PlacedProcedural(std::move(part), placement_, shutter_)));
  return parts;
}

Strands PlacedProcedural::generate() const {
  Strands strands = inner_->generate();
  if (strands.strand_count() == 0) return strands;
  const std::vector<double> times = shutter_.keys(static_cast<size_t>(strands.motion_keys()));
  size_t dropped = 0;
  return Strands(to_world(std::move(strands).release(), times, *placement_, shutter_, dropped));
}

StrandCounts PlacedProcedural::counts() const {
  StrandCounts counts = inner_->counts();
  counts.motion_keys = std::max(counts.motion_keys, shutter_.keys(placement_->sample_count()).size());
  return counts;
}

StrandScale PlacedProcedural::scale() const {
  const StrandScale inner = inner_->scale();
  const M44f matrix = placement_->at(shutter_.times.x);
  return {inner.width * mean_scale(matrix), inner.anchor * matrix, inner.widest * mean_scale(matrix)};
}

/// The strands before they are placed.
size_t PlacedProcedural::temporary_bytes() const {
  const StrandCounts inner = inner_->counts();
  return inner_->temporary_bytes() +
         sizeof(float) * (4 * inner.points * inner.motion_keys + inner.attribute_floats);
}

ChunkBounds PlacedProcedural::exact_bounds(BoundSpan, int keys) const {
  const Strands strands = generate();
  return SegmentParts(strands).exact_bounds(keys);
}

}  // namespace pelage
