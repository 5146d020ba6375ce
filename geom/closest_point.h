// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "base/vector.h"
#include "geom/tessellation.h"

namespace pelage {

struct Job;

/// The point of a skin nearest to a query point.
struct ClosestPoint {
  V3f position{0};
  V3f normal{0};        ///< interpolated limit normal there, unit
  float distance = 0;   ///< >= 0
  bool inside = false;  ///< on the inner side of a closed skin (angle-weighted pseudonormal [Baerentzen05])
  uint32_t triangle = 0;
};

/// Closest-point queries on one motion key of a skin, using a box tree over its triangles. `mesh` must
/// outlive this object. Thread safety: const members may be called from any thread.
class ClosestPointTree {
 public:
  /// With a job, throws Error (kStopped) when the job is stopped.
  ClosestPointTree(const SkinMesh& mesh, int key, const Job* job = nullptr);
  ~ClosestPointTree();
  ClosestPointTree(ClosestPointTree&&) noexcept;

  /// Nearest point within `limit`; false when there is none. Ties are broken by triangle number.
  bool closest(const V3f& point, float limit, ClosestPoint& result) const;
  size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pelage
