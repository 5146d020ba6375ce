// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "groom/strand_batch.h"

namespace pelage {

/// Rotation-minimising frames along the control polygons of a batch, one point after the other: the direction
/// of the polygon, and two perpendiculars with the least rotation about it (parallel transport; [Wang08]
/// compares methods). The frames start at the follicle's tangent, so they follow the skin into any pose.
class TransportedFrame {
 public:
  explicit TransportedFrame(const StrandBatch& batch);

  /// Advances to the next point, whose offsets must still be unmodified; operators displace a point after the
  /// frame has advanced to it.
  void advance(const StrandBatch& batch);

  const VectorRow& along() const { return along_; }
  const VectorRow& first() const { return first_; }
  /// Second perpendicular: along x first.
  V3f second(size_t strand) const { return vector_at(along_, strand).cross(vector_at(first_, strand)); }
  /// Adds a * first + b * second to point `point` of every strand.
  void displace(StrandBatch& batch, int point, const StrandRow& a, const StrandRow& b) const;

 private:
  VectorRow along_;
  VectorRow first_;
  VectorRow previous_;  // offsets of the previous point
  int point_ = 0;
};

}  // namespace pelage
