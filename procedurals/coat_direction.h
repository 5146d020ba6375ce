// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "geom/limit_surface.h"
#include "groom/groom.h"

namespace pelage {

class Workers;

/// How the strands of a groom lie at rest: the mean direction from root to tip, a continuous function of the
/// place, from some thousand of them. The same, bit by bit, however the groom is divided into leaves.
///
/// Immutable. Thread safety: const members may be called from any thread.
class CoatDirection {
 public:
  CoatDirection(const Groom& groom, std::shared_ptr<const LimitSurface> rest, const Workers& workers);

  /// In the pose in which the skin at `root` is `posed`: a unit vector, shorter where strands lie in many
  /// directions, zero where none stands.
  V3f at(const RootAddress& root, const SurfacePoint& posed) const;

 private:
  /// Calls use(node, weight) with the eight nodes around a place.
  template <class Use>
  void visit_nodes(const V3f& place, const Use& use) const;

  std::shared_ptr<const LimitSurface> rest_;
  V3f origin_{0};
  float cell_ = 1;
  int nodes_[3] = {2, 2, 2};
  std::vector<V3f> directions_;  // mean of unit vectors, by node
};

}  // namespace pelage
