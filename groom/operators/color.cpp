// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/color.h"

#include <algorithm>

#include "base/hash.h"
#include "base/value_readers.h"
#include "groom/strands/strand_batch.h"
#include "groom/strands/strand_fields.h"

namespace pelage {

const Schema<ColorParams>& ColorParams::schema() {
  static const Schema<ColorParams> table = [] {
    Schema<ColorParams> s(
        "color", "Sets the colour of strands: the attribute that materials read as `{attribute: color}`.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - color:
          variation: 0.3
          value: {ramp: {along: strand, knots: [[0, [0.03, 0.02, 0.02]], [1, [0.9, 0.25, 0.05]]]}})");
    s.set_picture("Left: one colour. Right: dark roots, red tips and random darkening.");
    s.key(
        "value", &ColorParams::value,
        {.help = "Colour along the strand. `{attribute: color}` is the colour that preceding operators set"});
    s.key("variation", &ColorParams::variation,
          {.help = "Random darkening: 0.4 gives 60 to 100 % of the brightness", .min = 0, .max = 1});
    return s;
  }();
  return table;
}

void Color::prepare(const PrepareContext& context) {
  seed_ = context.seed;
  params_.value = params_.value.with_textures(context.textures);
}

OperatorTraits Color::traits() const {
  const FieldDependence needs = params_.value.dependence();
  const bool same = !needs.surface && !needs.attributes && params_.variation == 0;
  return {.name = kName,
          .colors = needs.along ? AttributeClass::kPerPoint
                    : same      ? AttributeClass::kConstant
                                : AttributeClass::kPerStrand,
          .replaces_colors = !needs.attributes,
          .attributes_only = true,
          .rest_use = pelage::rest_use(needs)};
}

Operator::Brightness Color::brightness(uint64_t seed, uint64_t strand_id) const {
  return {1.0f - params_.variation * unit_float(hash64(seed, strand_id, random_use("color"))),
          1.0f - 0.5f * params_.variation};
}

void Color::apply(StrandBatch& batch) const {
  if (batch.colors.empty()) return;
  StrandRow factor;
  for (size_t s = 0; s < batch.count && params_.variation > 0; ++s)
    factor[s] = brightness(seed_, batch.ids[s]).value;
  StrandColor color(params_.value, batch);
  for (size_t p = 0; p < batch.colors.size(); ++p) {
    // Not in place: the value may read the strand's current colour.
    VectorRow value;
    color.at(static_cast<int>(p), value);
    for (size_t c = 0; c < 3; ++c) {
      const float* __restrict from = value[c].data();
      float* __restrict to = batch.colors[p][c].data();
      if (params_.variation > 0) {
        for (size_t s = 0; s < batch.count; ++s) to[s] = from[s] * factor[s];
      } else {
        std::copy_n(from, batch.count, to);
      }
    }
  }
}

}  // namespace pelage
