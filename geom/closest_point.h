// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "base/vector.h"
#include "geom/tessellation.h"

namespace pelage {

struct Job;

/// The point of a skin that is nearest to a query point.
struct ClosestPoint {
  V3f position{0};
  V3f normal{0};       ///< limit normal at `position`, interpolated over the triangle; unit
  float distance = 0;  ///< from the query point to `position`, >= 0
  /// Whether the query point is on the inner side of a closed skin (angle-weighted pseudonormal
  /// [Baerentzen05]).
  bool inside = false;
  uint32_t triangle = 0;  ///< index of the triangle in the mesh
};

/// Closest-point queries on one motion key of a skin. Searches a tree of boxes over the triangles of the
/// skin. `mesh` must outlive this object. Thread safety: const members may be called from any thread.
class ClosestPointTree {
 public:
  /// Builds the tree. If `job` is given, throws Error (kStopped) when it is stopped.
  ClosestPointTree(const SkinMesh& mesh, int key, const Job* job = nullptr);
  ~ClosestPointTree();
  ClosestPointTree(ClosestPointTree&&) noexcept;

  /// Sets `result` to the nearest point within the distance `limit`. Returns false, and leaves `result`
  /// unchanged, when there is no such point. Of several nearest triangles, takes the one with the lowest
  /// index.
  bool closest(const V3f& point, float limit, ClosestPoint& result) const;
  /// Does the same, but does not set `normal` and `inside`, which take a good part of the time.
  bool closest_position(const V3f& point, float limit, ClosestPoint& result) const;
  /// Memory of the tree, without the mesh.
  size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pelage
