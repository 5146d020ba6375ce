// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "geom/alembic/alembic_curve_form.h"
#include "geom/alembic/alembic_curves_writer.h"

namespace pelage {

/// A vertex of a curve in an Alembic file.
struct AlembicCurveVertex {
  V3f position;
  float width = 0;
  size_t point = 0;  ///< the point of the strands whose attributes the vertex has
};

/// The vertices of strands, as an Alembic file has them.
class AlembicCurveVertices {
 public:
  AlembicCurveVertices(const Strands& strands, AlembicHost host);

  /// The bytes of curveBasisAndType: type, whether the curves are periodic (never), and basis.
  uint8_t type() const { return static_cast<uint8_t>(type_); }
  uint8_t basis() const { return static_cast<uint8_t>(basis_); }
  /// Whether each curve begins and ends with a phantom vertex.
  bool phantom_ends() const { return phantom_ends_; }
  size_t count() const { return count_; }
  size_t count(size_t strand) const;
  /// Returns a vertex of a strand. `i` must be below count(strand).
  AlembicCurveVertex vertex(size_t strand, size_t i) const;

 private:
  AlembicCurveVertex point(const float* p, size_t index) const;

  const Strands& strands_;
  AlembicCurveType type_ = AlembicCurveType::kCubic;
  AlembicBasis basis_ = AlembicBasis::kNone;
  bool phantom_ends_ = false;
  bool knots_ = false;  // vertices are the points of the curve that belong to the points of the strand
  bool inner_ = false;  // the first and last points have no vertices
  bool swap_ = false;   // z is up
  size_t count_ = 0;
};

}  // namespace pelage
