// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "geom/closest_point.h"
#include "geom/limit_surface.h"
#include "groom/groom.h"
#include "groom/sim/guide_simulation.h"
#include "world/coat_motion.h"
#include "world/frame_characters.h"

namespace pelage {

/// Returns the skin of a part of a character at one time, in world space.
LimitSurface posed_skin(const FrameCharacter& character, size_t part, const Assets& assets, double time);

/// Returns the triangles of a skin, fine enough for collisions. They are the same for all poses, even for
/// those in which edges have no length, because collisions follow a triangle from one moment to the next.
SkinMesh guide_triangles(const LimitSurface& skin, const Job& job);

/// A skin at rest, on which guides grow.
class RestPose {
 public:
  /// `closest_points`: whether growth needs closest points. `rest` must outlive the object.
  RestPose(const LimitSurface& rest, bool closest_points, const Job& job);
  RestPose(const RestPose&) = delete;
  RestPose& operator=(const RestPose&) = delete;
  /// `guides_only`: see PosedSkin.
  PosedSkin skin(bool guides_only = false) const;

 private:
  const LimitSurface& rest_;
  SkinMesh mesh_;
  std::vector<ClosestPointTree> trees_;
};

/// Returns where the guides of a coat grow on a posed skin, times `scale`.
std::vector<RodRoot> guide_roots(const Groom& groom, const LimitSurface& skin, double scale);

/// Returns the guides of a coat as they are groomed where `dynamics` moves them, times `scale`. Their radii
/// are 0.
std::vector<GuideShape> groomed_guides(const Groom& groom, const LimitSurface& rest, double scale,
                                       const Job& job);

/// Returns the guides of a coat at a frame as strands in world space, where `dynamics` moves them, in the
/// order of Groom::guides(). FileMotion reads them again. `turns`: at this frame; empty: the guides follow
/// their skin rigidly. The strands have no widths.
Strands guide_strands(const Assets& assets, const MovingCoat& coat, double frame, const GuideTurns& turns,
                      const Job& job);

}  // namespace pelage
