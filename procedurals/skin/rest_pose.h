// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "geom/closest_point.h"
#include "geom/tessellation.h"
#include "groom/groom.h"

namespace pelage {

class Workers;

/// The skin of a groom at rest, for a character of scale 1.
class RestPose {
 public:
  /// `rest`: the skin at rest, which must outlive this object; null for a groom without a skin.
  RestPose(const Groom& groom, const LimitSurface* rest, const Workers& workers) {
    if (rest) pose_.keys = {rest, 1};
    if (!groom.needs_closest_point()) return;
    const View view;  // so distant that no face is large
    mesh_ = tessellate(pose_.keys, view, {}, workers);
    trees_.emplace_back(mesh_, 0);
    pose_.trees = trees_;
  }
  RestPose(const RestPose&) = delete;
  RestPose& operator=(const RestPose&) = delete;

  const PosedSkin& skin() const { return pose_; }

 private:
  PosedSkin pose_;
  SkinMesh mesh_;
  std::vector<ClosestPointTree> trees_;
};

}  // namespace pelage
