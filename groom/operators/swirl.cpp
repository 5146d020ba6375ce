// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/swirl.h"

#include <algorithm>
#include <cmath>

#include "base/value_readers.h"
#include "geom/limit_surface.h"
#include "groom/operators/combing.h"
#include "groom/operators/turning.h"
#include "groom/strands/rotation.h"
#include "groom/strands/skin_binding.h"
#include "groom/strands/strand_fields.h"

namespace pelage {
const Schema<SwirlParams>& SwirlParams::schema() {
  static const Schema<SwirlParams> table = [] {
    Schema<SwirlParams> s(
        "swirl",
        "Combs strands around a point of the skin: a whorl, a cowlick or a rosette. Lengths "
        "are kept.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - swirl: {center: [0, 0.5, 0], radius: 2, angle: 70, lift: 0.2})");
    s.set_picture("Left: straight strands. Right: a whorl.");
    s.key("center", &SwirlParams::center,
          {.unit = "scene units",
           .help = "Centre, in the rest space of the skin; moved to the nearest point of the skin",
           .required = true});
    s.key("radius", &SwirlParams::radius,
          {.unit = "scene units",
           .help =
               "Distance from the centre within which strands turn: fully up to half of this distance, less "
               "and less up to all of it",
           .min = 0,
           .above_min = true});
    s.key(
        "angle", &SwirlParams::angle,
        {.unit = "degrees",
         .help = "Angle from the direction away from the centre to the direction of the strands, "
                 "counterclockwise seen from outside: 0 falls outward, 90 runs around the centre, 180 points "
                 "to it",
         .min = -180,
         .max = 180});
    s.key("lift", &SwirlParams::lift,
          {.help = "How steeply strands rise: 0 lies on the skin, 1 stands upright", .min = 0, .max = 1});
    s.key("amount", &SwirlParams::amount,
          {.help = "How far strands turn from their current direction: 0 not at all, 1 fully",
           .min = 0,
           .max = 1});
    s.key("curve", &SwirlParams::curve,
          {.help = "Fraction of the strand, from the root, over which it turns; 0 turns the whole "
                   "strand at the root",
           .min = 0,
           .max = 1});
    return s;
  }();
  return table;
}

void Swirl::prepare(const PrepareContext& context) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorKind::kInput, context.position, "the operator swirl " + why);
  };
  if (!context.rest) refuse("needs strands that grow on a skin");
  const SkinBinding binding(*context.rest, "a swirl", context.job);
  if (binding.empty()) refuse("needs a skin with at least one face that is not a hole");
  const RootAddress root = binding.nearest(params_.center);
  center_ = context.rest->evaluate(root.face, root.u, root.v).position;
  normal_ = context.rest->frame(root.face, root.u, root.v).normal;
  params_.angle = params_.angle.with_textures(context.textures);
  params_.lift = params_.lift.with_textures(context.textures);
  params_.amount = params_.amount.with_textures(context.textures);
}

void Swirl::apply(StrandBatch& batch) const {
  constexpr float kUpright = 0.08f;  // of the radius: where strands rise to stand upright at the centre
  StrandRow angle, lift, amount;
  evaluate(params_.angle, batch, 0, angle);
  evaluate(params_.lift, batch, 0, lift);
  evaluate(params_.amount, batch, 0, amount);
  for (size_t s = 0; s < batch.count; ++s) {
    const V3f normal = vector_at(batch.rest.normal, s);
    const V3f way = vector_at(batch.rest.position, s) - center_;
    const float distance = way.length() / params_.radius;
    const float near = (1 - smooth_step(2 * distance - 1)) * smooth_step(2 * normal.dot(normal_));
    if (near <= 0) continue;
    const V3f out = normalised_or(way - normal * normal.dot(way), V3f(0));
    const V3f turned = Rotation{normal, angle[s] * (std::numbers::pi_v<float> / 180)}.apply(out);
    const float upright = 1 - smooth_step(distance / kUpright);
    comb_strand(batch, s, batch.from_rest(s, turned * (1 - upright) + normal * upright), lift[s],
                std::clamp(amount[s], 0.0f, 1.0f) * near, params_.curve);
  }
}

StrandReach Swirl::reach_after(const StrandReach& before) const {
  return reach_after_combing(before, params_.lift, params_.amount, params_.curve);
}

}  // namespace pelage
