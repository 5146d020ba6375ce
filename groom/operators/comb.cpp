// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/comb.h"

#include <algorithm>
#include <cmath>

#include "base/value_readers.h"
#include "groom/operators/turning.h"
#include "groom/strands/strand_fields.h"

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

const Schema<CombParams>& CombParams::schema() {
  static const Schema<CombParams> table = [] {
    Schema<CombParams> s("comb", "Combs strands in a direction along the skin. Lengths are kept.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - comb: {direction: [1, 0, 0], lift: 0.3})");
    s.set_picture("Left: straight strands. Right: combed to the right with `lift: 0.3`.");
    s.key("direction", &CombParams::direction,
          {.help = "Target direction in the rest space of the skin: a vector or a map of vectors. Only its "
                   "direction along the skin counts, not its length"});
    s.key("lift", &CombParams::lift,
          {.help = "How steeply strands rise: 0 lies on the skin, 1 stands upright", .min = 0, .max = 1});
    s.key(
        "amount", &CombParams::amount,
        {.help = "How far strands turn from their current direction to the combed one: 0 not at all, 1 fully",
         .min = 0,
         .max = 1});
    s.key("curve", &CombParams::curve,
          {.help = "Fraction of the strand, from the root, over which it turns; 0 turns the whole "
                   "strand at the root",
           .min = 0,
           .max = 1});
    return s;
  }();
  return table;
}

void Comb::prepare(const PrepareContext& context) {
  params_.direction = params_.direction.with_textures(context.textures);
  params_.lift = params_.lift.with_textures(context.textures);
  params_.amount = params_.amount.with_textures(context.textures);
}

void Comb::apply(StrandBatch& batch) const {
  VectorRow direction;
  StrandRow lift, amount;
  evaluate_color(params_.direction, batch, 0, direction);
  evaluate(params_.lift, batch, 0, lift);
  evaluate(params_.amount, batch, 0, amount);
  const TurnProfile profile{0, params_.curve, 1};
  const int tip = batch.segment_count();
  for (size_t s = 0; s < batch.count; ++s) {
    const Frame frame = batch.current.frame(s);
    const V3f target = combed_direction(batch.from_rest(s, vector_at(direction, s)), frame.normal, lift[s]);
    const V3f now = normalised_or(batch.offset(tip, s) - batch.offset(0, s), frame.normal);
    Rotation rotation = rotation_between(now, target, any_perpendicular(now));
    rotation.angle *= std::clamp(amount[s], 0.0f, 1.0f);
    turn_strand(batch, s, profile, rotation);
  }
}

float Comb::largest_turn(const StrandReach& before) const {
  // As long as the segments stay on one side of the skin, a chord leans no more than they do.
  const float lean = before.lean <= kQuarterTurn ? before.lean : std::numbers::pi_v<float>;
  const float target = kQuarterTurn * (1.0f - std::clamp(params_.lift.value_range().first, 0.0f, 1.0f));
  const float amount = std::clamp(params_.amount.value_range().second, 0.0f, 1.0f);
  return amount * std::min(lean + target, std::numbers::pi_v<float>);
}

StrandReach Comb::reach_after(const StrandReach& before) const {
  StrandReach after = before;
  after.lean = std::min(before.lean + largest_turn(before), std::numbers::pi_v<float>);
  if (params_.curve > 0) after.distance = after.length;
  return after;
}

}  // namespace pelage
