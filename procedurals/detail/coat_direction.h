// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "geom/limit_surface.h"
#include "groom/groom.h"

namespace pelage {

class Workers;

/// Mean direction of a groom's strands at rest, from root to tip, as a continuous function of the position on
/// the skin. It is computed from the strands with ids below 8192. The result is bit-identical for every
/// division of the groom into leaves.
///
/// Immutable. Thread safety: const members may be called from any thread.
class CoatDirection {
 public:
  CoatDirection(const Groom& groom, std::shared_ptr<const LimitSurface> rest, const Workers& workers);

  /// Returns the mean direction of the strands near `root`, rotated to a pose. `posed`: the point of the skin
  /// at `root` in this pose. The result is a unit vector if the mean of the strands' unit directions has at
  /// least length 1/2. If the mean is shorter, because the strands point in many directions, the result is
  /// twice the mean. Zero if there are no strands.
  V3f at(const RootAddress& root, const SurfacePoint& posed) const;

 private:
  /// Calls use(node, weight) for the eight nodes of the grid around a position.
  template <class Use>
  void visit_nodes(const V3f& place, const Use& use) const;

  std::shared_ptr<const LimitSurface> rest_;
  V3f origin_{0};
  float cell_ = 1;
  int nodes_[3] = {2, 2, 2};
  std::vector<V3f> directions_;  // per node of a grid: weighted mean of unit directions
};

}  // namespace pelage
