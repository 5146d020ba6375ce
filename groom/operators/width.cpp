// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/width.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/value_readers.h"
#include "groom/strands/strand_batch.h"
#include "groom/strands/strand_fields.h"

namespace pelage {

const Schema<WidthParams>& WidthParams::schema() {
  static const Schema<WidthParams> table = [] {
    Schema<WidthParams> s("width", "Sets the thickness of strands from root to tip.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - width: {root: 0.06, tip: 0.004, profile: 2})");
    s.set_picture("Left: thin strands. Right: thick roots and thin tips.");
    s.key("root", &WidthParams::root, {.unit = "scene units", .help = "Diameter at the root", .min = 0});
    s.key("tip", &WidthParams::tip, {.unit = "scene units", .help = "Diameter at the tip", .min = 0});
    s.key("profile", &WidthParams::profile,
          {.help = "Exponent of the taper from root to tip: 1 is a cone, larger values keep the root's "
                   "width along more of the strand",
           .min = 0.1,
           .max = 10});
    s.key("variation", &WidthParams::variation,
          {.help = "Random thinning: 0.4 gives 60 to 100 % of the width", .min = 0, .max = 1});
    return s;
  }();
  return table;
}

OperatorTraits Width::traits() const {
  const FieldDependence root = params_.root.dependence(), tip = params_.tip.dependence();
  return {.name = kName,
          .has_one_width_profile = !root.surface && !root.attributes && !tip.surface && !tip.attributes,
          .attributes_only = true,
          .rest_use = std::max(pelage::rest_use(root), pelage::rest_use(tip))};
}

void Width::prepare(const PrepareContext& context) {
  seed_ = context.seed;
  params_.root = params_.root.with_textures(context.textures);
  params_.tip = params_.tip.with_textures(context.textures);
}

void Width::apply(StrandBatch& batch) const {
  StrandField root(params_.root, batch), tip(params_.tip, batch);
  StrandRow factor;
  factor.fill(batch.scale);
  if (params_.variation > 0) {
    for (size_t s = 0; s < batch.count; ++s) {
      factor[s] *= 1.0f - params_.variation * unit_float(hash64(seed_, batch.ids[s], random_use("width")));
    }
  }
  for (int p = 0; p < batch.point_count(); ++p) {
    const float along = batch.along(p);
    const float to_tip = std::pow(along, params_.profile);
    const StrandRow& at_root = root.at(along);
    const StrandRow& at_tip = tip.at(along);
    float* __restrict radius = batch.points[static_cast<size_t>(p)].radius.data();
    for (size_t s = 0; s < batch.count; ++s) {
      radius[s] = 0.5f * factor[s] * std::max(at_root[s] + (at_tip[s] - at_root[s]) * to_tip, 0.0f);
    }
  }
}

StrandReach Width::reach_after(const StrandReach& before) const {
  StrandReach after = before;
  after.radius = 0.5f * std::max({params_.root.value_range().second, params_.tip.value_range().second, 0.0f});
  return after;
}

}  // namespace pelage
