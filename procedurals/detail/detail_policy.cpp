// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/detail_policy.h"

#include "procedurals/detail/coat_stats.h"

namespace pelage {

Simplification DetailPolicy::simplification(const Groom& groom, const LimitSurface* rest,
                                            const PosedCharacterSkin& skin) {
  auto known = stats_.find(&groom);
  if (known == stats_.end()) {
    known =
        stats_.emplace(&groom, coat_stats(groom, groom.grows_on_skin() ? rest : nullptr, job_.workers)).first;
  }
  CoatStats stats = known->second;
  stats.width *= skin.scale();
  stats.length *= skin.scale() * skin.length();
  stats.area_share *= skin.length();
  stats.density /= skin.scale() * skin.scale();
  SimplificationParams params = params_;
  if (groom.role() == StrandRole::kWhisker)
    params.motion_blur = params.depth_of_field = params.back_facing = false;
  const float budget = groom.role() == StrandRole::kGuard     ? params.guard
                       : groom.role() == StrandRole::kWhisker ? params.whisker
                                                              : params.under;
  return {params, view_, stats, budget};
}

std::shared_ptr<const CoatDirection> DetailPolicy::direction(
    const Groom& groom, const std::shared_ptr<const LimitSurface>& rest) {
  if (!blurs_ || !groom.grows_on_skin() || groom.role() == StrandRole::kWhisker) return {};
  std::shared_ptr<const CoatDirection>& known = directions_[&groom];
  if (!known) known = std::make_shared<const CoatDirection>(groom, rest, job_.workers);
  return known;
}

}  // namespace pelage
