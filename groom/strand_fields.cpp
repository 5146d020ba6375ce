// SPDX-License-Identifier: Apache-2.0
#include "groom/strand_fields.h"

#include <algorithm>
#include <array>

#include "base/hash.h"

namespace pelage {
namespace {

/// Calls `store(strand, point)` with the place of each strand; `attributes` of the point are valid meanwhile.
template <class Store>
void visit(const FieldDependence& needs, const StrandBatch& batch, float along, int point,
           const Store& store) {
  std::array<FieldAttribute, 3> attributes{{{"random", Rgb(0)}, {"clump", Rgb(0)}, {"color", Rgb(1)}}};
  FieldPoint place;
  place.along = along;
  if (needs.attributes) place.attributes = attributes;
  for (size_t s = 0; s < batch.count; ++s) {
    place.rest = vector_at(batch.rest.position, s);
    place.u = batch.u[s];
    place.v = batch.v[s];
    if (needs.attributes) {
      attributes[0].value = Rgb(unit_float(hash64(batch.ids[s], random_use("field random"))));
      attributes[1].value = Rgb(batch.clump[s]);
      if (!batch.colors.empty()) {
        const V3f c =
            vector_at(batch.colors[std::min(static_cast<size_t>(point), batch.colors.size() - 1)], s);
        attributes[2].value = Rgb(c.x, c.y, c.z);
      }
    }
    store(s, place);
  }
}

}  // namespace

void evaluate(const Field& field, const StrandBatch& batch, float along, StrandRow& out) {
  if (field.is_constant()) {
    out.fill(field.value({}));
    return;
  }
  visit(field.dependence(), batch, along, 0,
        [&](size_t s, const FieldPoint& place) { out[s] = field.value(place); });
}

void evaluate_color(const Field& field, const StrandBatch& batch, int point, VectorRow& out) {
  if (field.is_constant()) {
    const Rgb c = field.color({});
    out[0].fill(c.x);
    out[1].fill(c.y);
    out[2].fill(c.z);
    return;
  }
  visit(field.dependence(), batch, batch.along(point), point, [&](size_t s, const FieldPoint& place) {
    const Rgb c = field.color(place);
    set_vector(out, s, V3f(c.x, c.y, c.z));
  });
}

}  // namespace pelage
