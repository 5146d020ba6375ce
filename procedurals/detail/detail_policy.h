// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>

#include "base/job.h"
#include "lod/simplification.h"
#include "procedurals/detail/coat_direction.h"
#include "procedurals/skin/posed_character_skin.h"

namespace pelage {

/// Determines the level of detail of all coats of a frame. Measures each groom only once, even if many
/// characters have this groom.
class DetailPolicy {
 public:
  /// `job` must outlive this object. `shutter`: opening and closing time, in frames.
  DetailPolicy(const SimplificationParams& params, const LodView& view, const V2f& shutter, const Job& job)
      : params_(params), view_(view), blurs_(params.motion_blur && shutter.y > shutter.x), job_(job) {}

  /// Returns the simplification of a groom on the skin of a character. `rest`: the skin at rest; null for a
  /// groom without a skin. The share of whiskers depends only on their size in the picture, not on blur and
  /// facing. Whiskers are a few dozen isolated strands, so omitting more of them would be visible and would
  /// save nothing.
  Simplification simplification(const Groom& groom, const LimitSurface* rest, const PosedCharacterSkin& skin);

  /// Returns the mean directions of the groom's strands, which motion blur needs. Returns null when they are
  /// not needed: without motion blur, without a skin, and for whiskers.
  std::shared_ptr<const CoatDirection> direction(const Groom& groom,
                                                 const std::shared_ptr<const LimitSurface>& rest);

 private:
  const SimplificationParams params_;
  const LodView view_;
  const bool blurs_;
  const Job& job_;
  std::map<const Groom*, CoatStats> stats_;
  std::map<const Groom*, std::shared_ptr<const CoatDirection>> directions_;
};

}  // namespace pelage
