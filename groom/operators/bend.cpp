// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/bend.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/value_readers.h"
#include "groom/operators/turning.h"
#include "groom/strands/strand_fields.h"

namespace pelage {
namespace {

constexpr float kRadians = std::numbers::pi_v<float> / 180;

}  // namespace

const Schema<BendParams>& BendParams::schema() {
  static const Schema<BendParams> table = [] {
    Schema<BendParams> s("bend",
                         "Bends strands toward a direction. The bend grows from root to tip and never goes "
                         "beyond the target direction. Lengths are kept.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - bend: {direction: [1, 0, 0], angle: 90})");
    s.set_picture("Left: straight strands. Right: bent to the right by 90 degrees at the tip.");
    s.key("direction", &BendParams::direction,
          {.help = "Target direction in the rest space of the skin: a vector or a field of vectors, such "
                   "as a ramp, whose knots are directions"});
    s.key("angle", &BendParams::angle,
          {.unit = "degrees", .help = "Rotation at the tip", .min = 0, .max = 180});
    s.key(
        "start", &BendParams::start,
        {.help = "Where along the strand the bend begins: 0 is the root, 1 the tip", .min = 0, .max = 0.999});
    s.key("profile", &BendParams::profile,
          {.help = "Exponent of the bend from root to tip: 1 bends evenly like an arc, larger values bend "
                   "mostly the tip",
           .min = 0.1,
           .max = 10});
    s.key("variation", &BendParams::variation,
          {.help = "Random reduction of the angle: 0.4 gives 60 to 100 % of it", .min = 0, .max = 1});
    s.key("amount", &BendParams::amount, {.help = "Factor on the angle", .min = 0, .max = 1});
    return s;
  }();
  return table;
}

void Bend::prepare(const PrepareContext& context) {
  seed_ = context.seed;
  params_.direction = params_.direction.with_textures(context.textures);
  params_.angle = params_.angle.with_textures(context.textures);
  params_.amount = params_.amount.with_textures(context.textures);
}

void Bend::apply(StrandBatch& batch) const {
  VectorRow direction;
  StrandRow angle, amount;
  evaluate_color(params_.direction, batch, 0, direction);
  evaluate(params_.angle, batch, 0, angle);
  evaluate(params_.amount, batch, 0, amount);
  const TurnProfile profile{params_.start, 1, params_.profile};
  const int tip = batch.segment_count();
  for (size_t s = 0; s < batch.count; ++s) {
    const V3f normal = vector_at(batch.current.normal, s);
    const V3f target = normalised_or(batch.from_rest(s, vector_at(direction, s)), normal);
    const V3f now = normalised_or(batch.offset(tip, s) - batch.offset(0, s), normal);
    Rotation rotation = rotation_between(now, target, any_perpendicular(now));
    const float less = params_.variation * unit_float(hash64(seed_, batch.ids[s], random_use("bend")));
    rotation.angle = std::min(rotation.angle, std::clamp(angle[s], 0.0f, 180.0f) * kRadians * (1.0f - less)) *
                     std::clamp(amount[s], 0.0f, 1.0f);
    turn_strand(batch, s, profile, rotation);
  }
}

float Bend::largest_angle() const {
  return std::clamp(params_.angle.value_range().second, 0.0f, 180.0f) * kRadians *
         std::clamp(params_.amount.value_range().second, 0.0f, 1.0f);
}

StrandReach Bend::reach_after(const StrandReach& before) const {
  StrandReach after = before;
  after.lean = std::min(before.lean + largest_angle(), std::numbers::pi_v<float>);
  after.distance = after.length;
  return after;
}

}  // namespace pelage
