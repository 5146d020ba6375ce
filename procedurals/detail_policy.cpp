// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail_policy.h"

#include "procedurals/strand_nature.h"

namespace pelage {

Simplification DetailPolicy::simplification(const Groom& groom, const LimitSurface* rest,
                                            const PosedCharacterSkin& skin) {
  auto known = natures_.find(&groom);
  if (known == natures_.end()) {
    known =
        natures_.emplace(&groom, strand_nature(groom, groom.grows_on_skin() ? rest : nullptr, job_.workers))
            .first;
  }
  StrandNature nature = known->second;
  nature.width *= skin.scale();
  nature.length *= skin.scale() * skin.length();
  nature.area_share *= skin.length();
  nature.density /= skin.scale() * skin.scale();
  SimplificationParams params = params_;
  if (groom.role() == StrandRole::kWhisker)
    params.motion_blur = params.depth_of_field = params.turned_away = false;
  const float budget = groom.role() == StrandRole::kGuard     ? params.guard
                       : groom.role() == StrandRole::kWhisker ? params.whisker
                                                              : params.under;
  return {params, view_, nature, budget};
}

std::shared_ptr<const CoatLie> DetailPolicy::lie(const Groom& groom,
                                                 const std::shared_ptr<const LimitSurface>& rest) {
  if (!blurs_ || !groom.grows_on_skin() || groom.role() == StrandRole::kWhisker) return {};
  std::shared_ptr<const CoatLie>& known = lies_[&groom];
  if (!known) known = std::make_shared<const CoatLie>(groom, rest, job_.workers);
  return known;
}

}  // namespace pelage
