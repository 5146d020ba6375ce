// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>

#include "base/job.h"
#include "lod/simplification.h"
#include "procedurals/coat_direction.h"
#include "procedurals/posed_character_skin.h"

namespace pelage {

/// Level of detail of the coats of a frame. Measures each groom once, however many characters wear it.
class DetailPolicy {
 public:
  /// `job` must outlive this object. `shutter`: opening and closing time, in frames.
  DetailPolicy(const SimplificationParams& params, const LodView& view, const V2f& shutter, const Job& job)
      : params_(params), view_(view), blurs_(params.motion_blur && shutter.y > shutter.x), job_(job) {}

  /// Simplification of a groom on the skin of a character. `rest`: null for a groom without a skin. Whiskers
  /// are a few dozen isolated strands. They are thinned by size only: omitting more would be visible and
  /// would save nothing.
  Simplification simplification(const Groom& groom, const LimitSurface* rest, const PosedCharacterSkin& skin);

  /// Direction of the groom's strands, for motion blur; null when not needed.
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
