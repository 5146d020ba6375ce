// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/length.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/value_readers.h"
#include "groom/strands/strand_fields.h"

namespace pelage {

const Schema<LengthParams>& LengthParams::schema() {
  static const Schema<LengthParams> table = [] {
    Schema<LengthParams> s("length", "Scales each strand about its root to the given length.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: 0.8, variation: 0.8})");
    s.set_picture("Left: strands of length 0.8. Right: with `variation: 0.8`.");
    s.key("value", &LengthParams::value,
          {.unit = "scene units",
           .help = "Length of the strand",
           .min = 0,
           .default_text = "the current length (1 before any operator)"});
    s.key("scale", &LengthParams::scale, {.help = "Factor on the length", .min = 0});
    s.key("add", &LengthParams::add,
          {.unit = "scene units",
           .help = "Added to the length after `scale`; negative values shorten, down to nothing"});
    s.key("variation", &LengthParams::variation,
          {.help = "Random shortening: 0.4 gives 60 to 100 % of the length", .min = 0, .max = 1});
    return s;
  }();
  return table;
}

void Length::prepare(const PrepareContext& context) {
  seed_ = context.seed;
  if (params_.value) params_.value = params_.value->with_textures(context.textures);
  params_.scale = params_.scale.with_textures(context.textures);
  params_.add = params_.add.with_textures(context.textures);
}

void Length::apply(StrandBatch& batch) const {
  StrandRow length, factor, scale;
  arc_lengths(batch, length);
  evaluate(params_.scale, batch, 0, scale);
  if (params_.value) {
    evaluate(*params_.value, batch, 0, factor);
    for (size_t s = 0; s < batch.count; ++s) {
      factor[s] = length[s] > 0 ? std::max(factor[s], 0.0f) * batch.scale / length[s] : 0.0f;
    }
  } else {
    factor.fill(1.0f);
  }
  const bool adds = !params_.add.is_constant() || params_.add.value({}) != 0;
  StrandRow added;
  if (adds) evaluate(params_.add, batch, 0, added);
  for (size_t s = 0; s < batch.count; ++s) {
    const float shorter = params_.variation * unit_float(hash64(seed_, batch.ids[s], random_use("length")));
    float scaled = std::max(scale[s], 0.0f);
    if (adds) {
      const float now = length[s] * factor[s];
      scaled = now > 0 ? std::max(scaled + added[s] * batch.scale / now, 0.0f) : 0.0f;
    }
    factor[s] *= scaled * (1.0f - shorter);
  }
  const VectorRow base = batch.points.front().offset;
  for (size_t p = 1; p < batch.points.size(); ++p) {
    for (size_t axis = 0; axis < 3; ++axis) {
      float* __restrict offset = batch.points[p].offset[axis].data();
      const float* from = base[axis].data();
      for (size_t s = 0; s < batch.count; ++s) offset[s] = from[s] + (offset[s] - from[s]) * factor[s];
    }
  }
}

StrandReach Length::reach_after(const StrandReach& before) const {
  StrandReach after = before;
  const float scale = std::max(params_.scale.value_range().second, 0.0f);
  if (params_.value) {
    after.length = std::max(params_.value->value_range().second, 0.0f) * scale;
    after.distance = after.length;
  } else {
    after.length *= scale;
    after.distance *= scale;
  }
  const float added = std::max(params_.add.value_range().second, 0.0f);
  after.length += added;
  after.distance += added;
  return after;
}

}  // namespace pelage
