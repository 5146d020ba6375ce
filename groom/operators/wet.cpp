// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/wet.h"

#include <algorithm>
#include <cmath>

#include "base/value_readers.h"
#include "groom/operators/combing.h"
#include "groom/operators/turning.h"
#include "groom/strands/strand_fields.h"
#include "image/field_operations.h"

namespace pelage {
namespace {

constexpr float kRadiansOfDegree = std::numbers::pi_v<float> / 180;

}  // namespace

const Schema<WetParams>& WetParams::schema() {
  static const Schema<WetParams> table = [] {
    Schema<WetParams> s(
        "wet",
        "Wet hair: strands lie down along the skin, hang down under their weight and gather in "
        "clumps with common tips. Strands never become longer. Wet hair is also darker and "
        "shinier, which its material states.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - wet: {spacing: 0.45, gravity: [0.5, -1, 0.3], weight: 50})");
    s.set_picture("Left: straight strands. Right: the same strands, wet.");
    s.key("spacing", &WetParams::spacing,
          {.unit = "scene units", .help = "Mean distance between clumps", .min = 0, .above_min = true});
    s.key("gather", &WetParams::gather,
          {.help =
               "How far tips move toward the tip of the centre strand of their clump: 0 not at all, 1 fully",
           .min = 0,
           .max = 1});
    s.key("profile", &WetParams::profile,
          {.help = "Exponent of the gathering from root to tip. With values below 1, the strands of a clump "
                   "come together near the root; with values above 1, near the tip",
           .min = 0.1,
           .max = 10});
    s.key("strays", &WetParams::strays, {.help = "Fraction of strands left unclumped", .min = 0, .max = 1});
    s.key("gravity", &WetParams::gravity,
          {.help = "Direction of gravity in the rest space of the skin: a vector or a field of vectors"});
    s.key("weight", &WetParams::weight,
          {.unit = "degrees",
           .help = "How far strands bend toward gravity at the tip; they never bend into the skin",
           .min = 0,
           .max = 180});
    s.key("flatten", &WetParams::flatten,
          {.help = "How far strands lie down along the skin: 0 not at all, 1 fully", .min = 0, .max = 1});
    s.key("amount", &WetParams::amount,
          {.help = "Factor on `gather`, `weight` and `flatten`: 0 is dry", .min = 0, .max = 1});
    return s;
  }();
  return table;
}

Wet::Wet(WetParams params)
    : OperatorOf(std::move(params)),
      clumps_({.spacing = params_.spacing,
               .amount = product_field({params_.gather, params_.amount}),
               .profile = params_.profile,
               .strays = params_.strays,
               .levels = {}}) {}

void Wet::prepare(const PrepareContext& context) {
  params_.gravity = params_.gravity.with_textures(context.textures);
  params_.weight = params_.weight.with_textures(context.textures);
  params_.flatten = params_.flatten.with_textures(context.textures);
  params_.amount = params_.amount.with_textures(context.textures);
  clumps_.prepare_after(context, kName, [this](StrandBatch& batch) { weigh_down(batch); });
}

void Wet::apply(StrandBatch& batch) const {
  weigh_down(batch);
  clumps_.apply(batch);
}

void Wet::weigh_down(StrandBatch& batch) const {
  VectorRow gravity;
  StrandRow weight, flatten, amount;
  evaluate_color(params_.gravity, batch, 0, gravity);
  evaluate(params_.weight, batch, 0, weight);
  evaluate(params_.flatten, batch, 0, flatten);
  evaluate(params_.amount, batch, 0, amount);
  const int tip = batch.segment_count();
  for (size_t s = 0; s < batch.count; ++s) {
    const float wet = std::clamp(amount[s], 0.0f, 1.0f);
    const V3f normal = vector_at(batch.current.normal, s);
    const V3f down = batch.from_rest(s, normalised_or(vector_at(gravity, s), V3f(0)));
    const V3f lying = normalised_or(batch.offset(tip, s) - batch.offset(0, s), normal) + down * 0.5f;
    comb_strand(batch, s, lying - normal * std::max(lying.dot(normal), 0.0f), 0,
                wet * std::clamp(flatten[s], 0.0f, 1.0f), 0);
    // The part of gravity that leads into the skin cannot bend a strand that lies on it.
    const V3f pull = down - normal * std::min(down.dot(normal), 0.0f);
    const V3f now = normalised_or(batch.offset(tip, s) - batch.offset(0, s), normal);
    Rotation rotation = rotation_between(now, normalised_or(pull, now), any_perpendicular(now));
    rotation.angle = std::min(rotation.angle, std::clamp(weight[s], 0.0f, 180.0f) * kRadiansOfDegree) * wet *
                     std::min(pull.length(), 1.0f);
    turn_strand(batch, s, {}, rotation);
  }
}

StrandReach Wet::weighed_down(const StrandReach& before) const {
  StrandReach after = reach_after_combing(before, Field(0.0f), params_.flatten, 0);
  const float bend = std::clamp(params_.weight.value_range().second, 0.0f, 180.0f) * kRadiansOfDegree;
  after.lean = std::min(after.lean + bend, std::numbers::pi_v<float>);
  after.distance = after.length;
  return after;
}

StrandReach Wet::reach_after(const StrandReach& before) const {
  return clumps_.reach_after(weighed_down(before));
}

}  // namespace pelage
