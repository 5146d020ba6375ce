// SPDX-License-Identifier: Apache-2.0
#include "groom/color.h"

#include "base/hash.h"
#include "base/value_readers.h"
#include "groom/strand_batch.h"
#include "groom/strand_fields.h"

namespace pelage {

const Schema<ColorParams>& ColorParams::schema() {
  static const Schema<ColorParams> table = [] {
    Schema<ColorParams> s("color",
                          "Colours strands: the attribute that materials read as {attribute: color}.");
    s.key("value", &ColorParams::value,
          {.help = "Colour along the strand; may read the colour that operators before have given, as "
                   "{attribute: color}"});
    s.key("variation", &ColorParams::variation,
          {.help = "Part of its brightness that the darkest strand lacks", .min = 0, .max = 1});
    return s;
  }();
  return table;
}

void Color::prepare(const PrepareContext& context) {
  seed_ = context.seed;
  params_.value = params_.value.with_textures(context.textures);
}

std::optional<AttributeClass> Color::colors() const {
  const FieldDependence needs = params_.value.dependence();
  if (needs.along) return AttributeClass::kPerPoint;
  const bool same = !needs.surface && !needs.attributes && params_.variation == 0;
  return same ? AttributeClass::kConstant : AttributeClass::kPerStrand;
}

void Color::apply(StrandBatch& batch) const {
  for (size_t p = 0; p < batch.colors.size(); ++p) {
    VectorRow value;
    evaluate_color(params_.value, batch, static_cast<int>(p), value);
    if (params_.variation > 0) {
      for (size_t s = 0; s < batch.count; ++s) {
        const float factor =
            1.0f - params_.variation * unit_float(hash64(seed_, batch.ids[s], random_use("color")));
        for (StrandRow& channel : value) channel[s] *= factor;
      }
    }
    batch.colors[p] = value;
  }
}

}  // namespace pelage
