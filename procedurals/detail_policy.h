// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>

#include "base/job.h"
#include "lod/simplification.h"
#include "procedurals/coat_direction.h"
#include "procedurals/posed_character_skin.h"

namespace pelage {

/// What level of detail makes of the coats of a frame. What it has to know of a groom is measured once,
/// however many characters wear it.
class DetailPolicy {
 public:
  /// `job` outlives it. `shutter`: when it opens and closes, in frames.
  DetailPolicy(const SimplificationParams& params, const LodView& view, const V2f& shutter, const Job& job)
      : params_(params), view_(view), blurs_(params.motion_blur && shutter.y > shutter.x), job_(job) {}

  /// Of a groom on the skin of a character. `rest`: null for a groom on no skin. Whiskers, some dozen strands
  /// that stand alone, are thinned by size only: leaving out more saves nothing and shows.
  Simplification simplification(const Groom& groom, const LimitSurface* rest, const PosedCharacterSkin& skin);

  /// How its strands lie, which motion blur asks for; null where it does not.
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
