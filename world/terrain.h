// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/job.h"
#include "base/ledger.h"
#include "base/vector.h"
#include "geom/limit_surface.h"

namespace pelage {

/// Heights of skins above the plane of x and z, for animals that stand on them. World space. Thread safety:
/// const members may be called from any thread.
class Terrain {
 public:
  struct Surface {
    std::shared_ptr<const LimitSurface> rest;
    M44f to_world;
  };
  struct Point {
    float height = 0;     ///< y
    V3f normal{0, 1, 0};  ///< unit, upward
  };

  /// Throws Error: kMemory when the triangles do not fit, kStopped when the job is stopped.
  Terrain(std::vector<Surface> surfaces, const Job& job);
  /// Returns the highest point of the surfaces above or below (x, z). Empty if there is none. The point is on
  /// the limit surface: triangles only find the face.
  std::optional<Point> at(float x, float z) const;

 private:
  struct Triangle {
    uint32_t surface, face;
    V3f corner[3];  // world space
    V2f uv[3];      // in the face
  };
  void add_triangles(uint32_t surface, const Job& job);
  void sort_into_cells(const Job& job);
  size_t cell_of(float value, int axis) const;
  Point refined(const Triangle& triangle, V2f uv, float x, float z) const;

  std::vector<Surface> surfaces_;
  MemoryCharge charge_, cells_charge_;
  std::vector<Triangle> triangles_;
  V2f low_{0}, cell_{1};
  size_t columns_ = 1, rows_ = 1;
  std::vector<uint32_t> first_, in_cells_;  // triangles of each cell of a grid
};

}  // namespace pelage
