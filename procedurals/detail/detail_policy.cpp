// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/detail_policy.h"

#include <cmath>

#include "procedurals/detail/coat_stats.h"
#include "procedurals/detail/fit_coverage.h"
#include "procedurals/detail/root_spacing.h"

namespace pelage {
namespace {

// Fraction of the strands that secondary rays see from afar: at most the first, and halves of it down to the
// second as long as the fit of their widths changes them by no more than a twentieth. Where it would, the
// wide strands no longer lie like the strands that they replace.
constexpr float kDistantFraction = 1.0f / 4, kSmallestFraction = 1.0f / 32;
constexpr float kLeastFit = 0.95f;

/// `fit`: of the widths; empty if unknown.
float distant_fraction(const std::optional<WidthFit>& fit) {
  float fraction = kDistantFraction;
  while (fit && fraction > kSmallestFraction && fit->at(fraction / 2) >= kLeastFit) fraction /= 2;
  return fraction;
}

}  // namespace

CoatStats DetailPolicy::stats(const Groom& groom, const LimitSurface* rest, const PosedCharacterSkin& skin) {
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
  return stats;
}

Simplification DetailPolicy::simplification(const Groom& groom, const LimitSurface* rest,
                                            const PosedCharacterSkin& skin) {
  SimplificationParams params = params_;
  if (groom.role() == StrandRole::kWhisker)
    params.motion_blur = params.depth_of_field = params.back_facing = false;
  const float budget = groom.role() == StrandRole::kGuard     ? params.guard
                       : groom.role() == StrandRole::kWhisker ? params.whisker
                                                              : params.under;
  return {params, view_, stats(groom, rest, skin), budget};
}

/// The mean distance between the strands of a coat at full detail; 0 if unknown.
float DetailPolicy::spacing(const Groom& groom, const CoatStats& stats, const PosedCharacterSkin& skin) {
  if (stats.density > 0) return 1 / std::sqrt(stats.density);
  if (groom.grows_on_skin()) return 0;
  const auto known = spacings_.find(&groom);
  if (known != spacings_.end()) return skin.scale() * known->second;
  return skin.scale() * spacings_.emplace(&groom, root_spacing(groom, job_.workers)).first->second;
}

std::optional<DetailPolicy::Distant> DetailPolicy::distant(const Groom& groom, const LimitSurface* rest,
                                                           const PosedCharacterSkin& skin, bool reduced) {
  if (groom.role() == StrandRole::kWhisker) return {};
  const CoatStats coat = stats(groom, rest, skin);
  const float between = spacing(groom, coat, skin);
  if (!(between > 0)) return {};
  SimplificationParams full;
  full.size = full.motion_blur = full.depth_of_field = full.back_facing = false;
  const std::shared_ptr<const EvenPriorities> order = priorities(groom);
  const std::optional<WidthFit>& fit = width_fit(groom, rest, order.get(), between / skin.scale());
  const Simplification seen =
      reduced ? simplification(groom, rest, skin) : Simplification(full, view_, coat, 1);
  const float fraction = distant_fraction(fit);
  return Distant{seen.distant(fraction, fit.value_or(WidthFit())), near_distance(fraction, between), order};
}

/// `between`: spacing() at rest.
const std::optional<WidthFit>& DetailPolicy::width_fit(const Groom& groom, const LimitSurface* rest,
                                                       const EvenPriorities* priorities, float between) {
  const auto known = fits_.find(&groom);
  if (known != fits_.end()) return known->second;
  if (!groom.grows_on_skin()) rest = nullptr;
  SimplificationParams full;
  const Simplification seen(full, view_, stats_.at(&groom), 1);
  return fits_.emplace(&groom, fit_coverage(groom, rest, priorities, seen, between, job_)).first->second;
}

std::shared_ptr<const EvenPriorities> DetailPolicy::priorities(const Groom& groom) {
  if (groom.has_priority_order()) return {};
  std::shared_ptr<const EvenPriorities>& known = priorities_[&groom];
  if (!known) known = std::make_shared<const EvenPriorities>(groom, job_.ledger);
  return known;
}

std::shared_ptr<const CoatDirection> DetailPolicy::direction(
    const Groom& groom, const std::shared_ptr<const LimitSurface>& rest) {
  if (!blurs_ || !groom.grows_on_skin() || groom.role() == StrandRole::kWhisker) return {};
  std::shared_ptr<const CoatDirection>& known = directions_[&groom];
  if (!known) known = std::make_shared<const CoatDirection>(groom, rest, job_.workers);
  return known;
}

}  // namespace pelage
