// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "geom/limit_surface.h"
#include "groom/groom.h"

namespace pelage {

class Workers;

/// Mean direction of a groom's strands at rest, from root to tip, as a continuous function of position,
/// computed from some thousand strands. Bit-identical however the groom is divided into leaves.
///
/// Immutable. Thread safety: const members may be called from any thread.
class CoatDirection {
 public:
  CoatDirection(const Groom& groom, std::shared_ptr<const LimitSurface> rest, const Workers& workers);

  /// The direction in the pose in which the skin at `root` is `posed`. A unit vector where all strands are
  /// parallel, shorter where they point in many directions, zero where there are no strands.
  V3f at(const RootAddress& root, const SurfacePoint& posed) const;

 private:
  /// Calls use(node, weight) for the eight nodes around a position.
  template <class Use>
  void visit_nodes(const V3f& place, const Use& use) const;

  std::shared_ptr<const LimitSurface> rest_;
  V3f origin_{0};
  float cell_ = 1;
  int nodes_[3] = {2, 2, 2};
  std::vector<V3f> directions_;  // mean of unit vectors, per node
};

}  // namespace pelage
