// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/vector.h"
#include "groom/operators/operator.h"

namespace pelage {

class ClosestPointTree;

/// One strand while it is moved out of a closed mesh, in the space of the mesh.
///
/// Afterwards, no point of the strand's curve lies inside, and control points keep a distance that grows from
/// 0 at the root. Segments keep their lengths as far as possible. A strand that cannot be moved out is
/// shortened: it ends at the last point of its curve outside. If its root is inside, a thousandth of its
/// length is left.
class PushedStrand {
 public:
  /// `normal`: of the skin at the root. `depth`: of the root inside the mesh, or 0 if it is outside or on it.
  PushedStrand(const ClosestPointTree& mesh, const V3f& root, const V3f& normal, float depth = 0)
      : mesh_(mesh), root_(root), normal_(normal), depth_(depth) {}

  /// Adds the next control point, as an offset from the root. The first is the start of the strand.
  void add(const V3f& offset);
  /// `distance`: of the control points from the mesh. `iterations`: max number of passes. `tangent`: a
  /// direction along the mesh, for strands that lead straight into it.
  void push_out(float distance, int iterations, const V3f& tangent);
  /// Whether every control point keeps `distance`, and no point of the curve is inside.
  bool is_clear(float distance) const;
  V3f offset(int point) const { return points_[static_cast<size_t>(point)] - root_; }

  /// Returns bounds after push_out(). No point is farther from its root than the strand was long, times 1.02.
  static StrandReach reach_after(const StrandReach& before);

 private:
  void slide(float offset, int rounds, const V3f& tangent);
  void push_points(float offset);
  bool push_curve();
  void draw_back();
  float clearance(size_t p, float offset) const;
  float depth_limit(const V3f& point) const { return (point - root_).length() + depth_; }
  bool push(V3f& point, float distance, float limit, V3f* out_of = nullptr) const;
  bool is_outside(size_t segment) const;
  V3f curve(size_t segment, float t) const;

  const ClosestPointTree& mesh_;
  V3f root_;
  V3f normal_;
  float depth_;
  std::vector<V3f> points_;
  std::vector<float> lengths_;  // of the segment that ends at each point
  std::vector<float> arcs_;
};

}  // namespace pelage
