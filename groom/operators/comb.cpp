// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/comb.h"

#include "base/value_readers.h"
#include "groom/operators/combing.h"
#include "groom/strands/strand_fields.h"

namespace pelage {
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
          {.help = "Target direction in the rest space of the skin: a vector or a field of vectors, such "
                   "as a ramp, whose knots are directions. Only its "
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
  for (size_t s = 0; s < batch.count; ++s) {
    comb_strand(batch, s, batch.from_rest(s, vector_at(direction, s)), lift[s], amount[s], params_.curve);
  }
}

StrandReach Comb::reach_after(const StrandReach& before) const {
  return reach_after_combing(before, params_.lift, params_.amount, params_.curve);
}

}  // namespace pelage
