// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "groom/strands/guide_turns.h"

namespace pelage {

class ClosestPointTree;

/// Number of strands that operators process together: small enough for the L2 cache, large enough for SIMD.
inline constexpr size_t kBlockStrands = 256;
/// One number per strand of a batch. Three of these rows store a vector per strand.
using StrandRow = std::array<float, kBlockStrands>;
using VectorRow = std::array<StrandRow, 3>;

inline V3f vector_at(const VectorRow& row, size_t strand) {
  return {row[0][strand], row[1][strand], row[2][strand]};
}
inline void set_vector(VectorRow& row, size_t strand, const V3f& value) {
  row[0][strand] = value.x;
  row[1][strand] = value.y;
  row[2][strand] = value.z;
}

/// Roots of the strands of a batch.
struct RootRows {
  VectorRow position;
  VectorRow tangent, bitangent, normal;  ///< orthonormal follicle frames

  void set(size_t strand, const V3f& position_of_root, const Frame& frame);
  Frame frame(size_t strand) const {
    return {vector_at(tangent, strand), vector_at(bitangent, strand), vector_at(normal, strand)};
  }
};

/// A block of strands while operators are applied to it. Data is in rows over the strands: [point][strand].
///
/// Points are offsets from the root along the axes of the batch's space. This is rest space for frozen
/// operators, and the posed space of one motion key for live operators. All strands of a batch have the same
/// number of points. Point 0 is the first point of the strand. Its offset is zero for grown strands; an
/// imported strand may start away from the skin. Operators must not move point 0.
struct StrandBatch {
  struct PointRows {
    VectorRow offset;
    StrandRow radius;  ///< half the width
  };

  size_t count = 0;
  std::vector<PointRows> points;
  /// One element per point, or one for whole strands, or none if no colours are needed.
  std::vector<VectorRow> colors;
  std::array<uint64_t, kBlockStrands> ids;
  RootRows rest;                             ///< roots in rest space
  RootRows current;                          ///< roots in the batch's space
  StrandRow u, v;                            ///< texture coordinates of the roots
  std::array<uint32_t, kBlockStrands> face;  ///< ptex faces of the roots, if they are on a skin
  StrandRow face_u, face_v;                  ///< parameters of the roots in these faces
  StrandRow clump;                           ///< random number of the strand's clump, or of the strand itself
  const ClosestPointTree* skin = nullptr;    ///< the posed skin, for operators that need it
  const GuideTurns* turns = nullptr;         ///< of the guides of `dynamics`; null: as groomed
  /// Scale of the character: length in the batch's space of a scene unit in operator parameters.
  float scale = 1;
  bool posed = false;  ///< whether the batch's space is a posed space

  /// Returns the memory of a batch of strands with this number of points.
  static int64_t bytes(int points, bool colored) {
    return static_cast<int64_t>(sizeof(StrandBatch)) +
           static_cast<int64_t>(sizeof(PointRows) + (colored ? sizeof(VectorRow) : 0)) * points;
  }
  int point_count() const { return static_cast<int>(points.size()); }
  int segment_count() const { return point_count() - 1; }
  V3f offset(int point, size_t strand) const {
    return vector_at(points[static_cast<size_t>(point)].offset, strand);
  }
  void set_offset(int point, size_t strand, const V3f& value) {
    set_vector(points[static_cast<size_t>(point)].offset, strand, value);
  }
  /// Returns the position of a point along its strand: 0 at the root, 1 at the tip, in equal steps from point
  /// to point.
  float along(int point) const { return static_cast<float>(point) / static_cast<float>(segment_count()); }
  /// Transforms a direction from rest space to the batch's space, using the follicle frames.
  V3f from_rest(size_t strand, const V3f& direction) const {
    return posed ? current.frame(strand).to_world(rest.frame(strand).to_local(direction)) : direction;
  }
  /// Transforms an offset from the batch's space to rest space: the inverse of from_rest() and of the scale.
  V3f to_rest(size_t strand, const V3f& offset) const {
    return posed ? rest.frame(strand).to_world(current.frame(strand).to_local(offset)) * (1 / scale) : offset;
  }
};

/// Makes straight strands of unit length and zero width along the root normals of `batch.rest`. Copies the
/// rest frames to `current`.
void start_strands(StrandBatch& batch, int points);

/// Sets widths to 0 and colours to white, as before the first operator.
void clear_attributes(StrandBatch& batch);
void scale_radii(StrandBatch& batch, float scale);

/// Transforms offsets from rest space to the pose whose roots are in batch.current. Multiplies offsets and
/// radii by `scale`.
void carry_to_pose(StrandBatch& batch, float scale);

/// Sets `lengths` to the arc length of each strand's control polygon.
void arc_lengths(const StrandBatch& batch, StrandRow& lengths);

}  // namespace pelage
