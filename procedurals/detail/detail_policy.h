// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "base/job.h"
#include "lod/simplification.h"
#include "procedurals/detail/coat_direction.h"
#include "procedurals/detail/even_priorities.h"
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

  /// A coat as secondary rays see it from afar.
  struct Distant {
    Simplification lod;
    float from;  ///< distance from the origin of the ray, in scene units: near_distance()
    /// Null: those of the groom. Other rays see the strands that the random numbers of the groom select, with
    /// or without an approximation for secondary rays.
    std::shared_ptr<const EvenPriorities> priorities;
  };
  /// Returns how secondary rays see a coat from afar. `reduced`: whether simplification() applies to the coat
  /// for other rays. Empty if such rays see the same strands as other rays: for whiskers, and where the
  /// distance between strands is unknown.
  std::optional<Distant> distant(const Groom& groom, const LimitSurface* rest, const PosedCharacterSkin& skin,
                                 bool reduced);

  /// Returns the mean directions of the groom's strands, which motion blur needs. Returns null when they are
  /// not needed: without motion blur, without a skin, and for whiskers.
  std::shared_ptr<const CoatDirection> direction(const Groom& groom,
                                                 const std::shared_ptr<const LimitSurface>& rest);

 private:
  CoatStats stats(const Groom& groom, const LimitSurface* rest, const PosedCharacterSkin& skin);
  std::shared_ptr<const EvenPriorities> priorities(const Groom& groom);
  const std::optional<WidthFit>& width_fit(const Groom& groom, const LimitSurface* rest,
                                           const EvenPriorities* priorities, float between);
  float spacing(const Groom& groom, const CoatStats& stats, const PosedCharacterSkin& skin);

  const SimplificationParams params_;
  const LodView view_;
  const bool blurs_;
  const Job& job_;
  std::map<const Groom*, CoatStats> stats_;
  std::map<const Groom*, std::optional<WidthFit>> fits_;
  std::map<const Groom*, float> spacings_;  // of strands without a skin
  std::map<const Groom*, std::shared_ptr<const EvenPriorities>> priorities_;
  std::map<const Groom*, std::shared_ptr<const CoatDirection>> directions_;
};

}  // namespace pelage
