// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/noise.h"

#include <algorithm>
#include <cmath>

#include "base/value_readers.h"
#include "groom/strands/strand_fields.h"

namespace pelage {

const Schema<NoiseParams>& NoiseParams::schema() {
  static const Schema<NoiseParams> table = [] {
    Schema<NoiseParams> s("noise",
                          "Displaces neighbouring strands together, by smooth noise over the rest skin. The "
                          "root stays in place; lengths change.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - noise: {amplitude: 0.5, frequency: 1})");
    s.set_picture("Left: straight strands. Right: neighbouring strands move together, `amplitude: 0.5`.");
    s.key("amplitude", &NoiseParams::amplitude,
          {.unit = "scene units", .help = "Maximum displacement of the tip", .min = 0});
    s.key("frequency", &NoiseParams::frequency,
          {.unit = "1 / scene unit", .help = "Noise frequency over the skin", .min = 0});
    s.key("frequency_along", &NoiseParams::along,
          {.help = "Noise frequency along the strand, from root to tip", .min = 0, .old_names = {"along"}});
    s.key("profile", &NoiseParams::profile,
          {.help = "Exponent of the displacement from root to tip: 1 grows evenly, larger values move mostly "
                   "the tip",
           .min = 0.1,
           .max = 10});
    return s;
  }();
  return table;
}

void Noise::prepare(const PrepareContext& context) {
  seed_ = static_cast<uint32_t>(context.seed);
  params_.amplitude = params_.amplitude.with_textures(context.textures);
}

void Noise::apply(StrandBatch& batch) const {
  StrandField amplitude(params_.amplitude, batch);
  const V3f drift(0.37f, 0.61f, 0.70f);  // direction of strands through the noise, not aligned to its lattice
  for (int p = 1; p < batch.point_count(); ++p) {
    const float along = batch.along(p);
    const float envelope = std::pow(along, params_.profile) * batch.scale;
    const StrandRow& size = amplitude.at(along);
    for (size_t s = 0; s < batch.count; ++s) {
      const V3f place =
          vector_at(batch.rest.position, s) * params_.frequency + drift * (along * params_.along);
      V3f push = perlin_noise3(place, seed_);
      const float length = push.length();
      if (length > 1.0f) push *= 1.0f / length;
      push = batch.from_rest(s, push) * (envelope * std::max(size[s], 0.0f));
      batch.set_offset(p, s, batch.offset(p, s) + push);
    }
  }
}

StrandReach Noise::reach_after(const StrandReach& before) const {
  return before.displaced(std::max(params_.amplitude.value_range().second, 0.0f));
}

}  // namespace pelage
