// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/push_out.h"

#include <algorithm>

#include "base/check.h"
#include "base/value_readers.h"
#include "groom/operators/pushed_strand.h"
#include "groom/strands/strand_fields.h"

namespace pelage {
const Schema<PushOutParams>& PushOutParams::schema() {
  static const Schema<PushOutParams> table = [] {
    Schema<PushOutParams> s("push_out", "Pushes strands out of the posed skin. Runs in every pose.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - comb: {direction: [1, 0, 0], lift: 0.1}
      - bend: {direction: [0, -1, 0], angle: 120}
      - push_out: {offset: 0.02})");
    s.set_picture("Left: strands bent into the skin. Right: the same strands pushed out of it.");
    s.key("offset", &PushOutParams::offset,
          {.unit = "scene units",
           .help = "Minimum distance between strands and skin, except near the roots",
           .min = 0});
    s.key("iterations", &PushOutParams::iterations,
          {.help = "Maximum number of passes", .min = 1, .max = 64});
    return s;
  }();
  return table;
}

void PushOut::prepare(const PrepareContext& context) {
  params_.offset = params_.offset.with_textures(context.textures);
}

void PushOut::apply(StrandBatch& batch) const {
  PELAGE_CHECK(batch.skin != nullptr);
  StrandRow offset;
  evaluate(params_.offset, batch, 0, offset);
  for (size_t s = 0; s < batch.count; ++s) {
    PushedStrand strand(*batch.skin, vector_at(batch.current.position, s),
                        vector_at(batch.current.normal, s));
    for (int p = 0; p < batch.point_count(); ++p) strand.add(batch.offset(p, s));
    strand.push_out(std::max(offset[s], 0.0f) * batch.scale, params_.iterations,
                    vector_at(batch.current.tangent, s));
    for (int p = 1; p < batch.point_count(); ++p) batch.set_offset(p, s, strand.offset(p));
  }
}

StrandReach PushOut::reach_after(const StrandReach& before) const {
  return PushedStrand::reach_after(before);
}

}  // namespace pelage
