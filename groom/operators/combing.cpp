// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/combing.h"

#include <algorithm>
#include <cmath>

#include "groom/operators/turning.h"

namespace pelage {
namespace {

constexpr float kQuarterTurn = std::numbers::pi_v<float> / 2;

/// Target direction of a strand at a root with this frame. If the direction is nearly normal to the skin, its
/// component along the skin is uncertain: where that component is shorter than a fifth of the direction's
/// length, the strand is gradually raised to the normal, so that the coat has no seam there.
V3f combed_direction(const V3f& direction, const V3f& normal, float lift) {
  const V3f unit = normalised_or(direction, normal);
  const V3f along_skin = unit - normal * unit.dot(normal);
  const float x = std::min(along_skin.length() / 0.2f, 1.0f);
  const float weight = x * x * (3.0f - 2.0f * x);
  const float angle = std::clamp(lift, 0.0f, 1.0f) * kQuarterTurn;
  const float flat = std::cos(angle) * weight;
  const float up = std::sin(angle) + std::cos(angle) * (1.0f - weight);
  return normalised_or(normalised_or(along_skin, V3f(0)) * flat + normal * up, normal);
}

}  // namespace

void comb_strand(StrandBatch& batch, size_t s, const V3f& direction, float lift, float amount, float curve) {
  const V3f normal = vector_at(batch.current.normal, s);
  const V3f target = combed_direction(direction, normal, lift);
  const V3f now = normalised_or(batch.offset(batch.segment_count(), s) - batch.offset(0, s), normal);
  Rotation rotation = rotation_between(now, target, any_perpendicular(now));
  rotation.angle *= std::clamp(amount, 0.0f, 1.0f);
  turn_strand(batch, s, {0, curve, 1}, rotation);
}

StrandReach reach_after_combing(const StrandReach& before, const Field& lift, const Field& amount,
                                float curve) {
  // As long as the segments stay on one side of the skin, a chord leans no more than they do.
  const float lean = before.lean <= kQuarterTurn ? before.lean : std::numbers::pi_v<float>;
  const float target = kQuarterTurn * (1.0f - std::clamp(lift.value_range().first, 0.0f, 1.0f));
  const float turn = std::clamp(amount.value_range().second, 0.0f, 1.0f) *
                     std::min(lean + target, std::numbers::pi_v<float>);
  StrandReach after = before;
  after.lean = std::min(before.lean + turn, std::numbers::pi_v<float>);
  if (curve > 0) after.distance = after.length;
  return after;
}

}  // namespace pelage
