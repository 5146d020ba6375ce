// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/job.h"
#include "base/vector.h"
#include "geom/tessellation.h"

namespace pelage {

/// A ball inside a skin at one time of the shutter.
struct SkinBall {
  V3f center{0};
  float radius = 0;
};

/// For each cell of a closed skin, a ball inside the skin below the cell: of the balls that the search meets,
/// the one that hides most directions from a point above the skin.
///
/// Balls are found by shrinking: a ball with its center on the inner normal of a skin point becomes smaller
/// until no other skin point is inside [Ma12]. Cells are the cubes of a grid over the skin at shutter open.
/// They do not depend on faces, because imported strands have none, and faces may be smaller than a cell.
///
/// Guarantee: at every time of the shutter, no point of the surface is in a ball, and the winding number of
/// the ball is not 0. A path from a point of a ball to any point outside bounds() therefore crosses the
/// surface. Between motion keys, vertices and centers move in straight lines. Cells without such a ball have
/// none. The balls are a function of the mesh only. Thread safety: const members may be called from any
/// thread.
class SkinBalls {
 public:
  /// Computes the balls; none if the mesh is not closed. Throws Error (kStopped) when the job is stopped.
  SkinBalls(const SkinMesh& mesh, const Job& job);
  /// Returns the max temporary memory of the constructor, in bytes.
  static size_t temporary_bytes(const SkinMesh& mesh);

  size_t size() const { return radii_.size(); }
  /// Returns the index of the ball of the cell that contains a point of the skin at shutter open, or of the
  /// nearest neighbouring cell. Empty if there is none.
  std::optional<uint32_t> find(const V3f& at_open) const;
  /// Returns a ball at a time of the shutter, in [0, 1].
  SkinBall ball(uint32_t index, float time) const;
  /// Box of the skin over the whole shutter.
  const Box3f& bounds() const { return bounds_; }
  size_t bytes() const;

 private:
  struct Sample;
  struct Builder;

  uint32_t slot_of(uint64_t key) const;
  void insert(uint64_t key, uint32_t ball);

  int keys_ = 1;
  Box3f bounds_;
  V3f origin_{0};                  // of the grid
  float inverse_size_ = 0;         // 1 / side of a cell
  std::vector<V3f> centers_;       // by ball and motion key
  std::vector<float> radii_;       // by ball
  std::vector<V3f> places_;        // by ball: the skin point at shutter open
  std::vector<uint64_t> slots_;    // hash table: keys of cells; its size is a power of two
  std::vector<uint32_t> indices_;  // ball of each slot; kEmpty: unused
};

}  // namespace pelage
