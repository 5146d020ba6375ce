// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "groom/strands/strand_batch.h"

namespace pelage {

/// Rotation-minimising frames along the control polygons of a batch, for one point after the other. A frame
/// consists of the direction of the polygon and of two perpendiculars that rotate as little as possible about
/// this direction (parallel transport; [Wang08] compares methods). The first frame is aligned with the
/// follicle's tangent, so the frames follow the skin into any pose.
class TransportedFrame {
 public:
  explicit TransportedFrame(const StrandBatch& batch);

  /// Advances the frame to the next point. The offset of this point must not have been displaced yet:
  /// operators displace a point after the frame has advanced to it.
  void advance(const StrandBatch& batch);

  /// Direction of the polygon.
  const VectorRow& along() const { return along_; }
  /// First perpendicular.
  const VectorRow& first() const { return first_; }
  /// Second perpendicular: the cross product of along() and first().
  V3f second(size_t strand) const { return vector_at(along_, strand).cross(vector_at(first_, strand)); }
  /// Adds a * first + b * second to point `point` of every strand.
  void displace(StrandBatch& batch, int point, const StrandRow& a, const StrandRow& b) const;

 private:
  VectorRow along_;
  VectorRow first_;
  VectorRow previous_;  // offset of the previous point of each strand
  int point_ = 0;
};

}  // namespace pelage
