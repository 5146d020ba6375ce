// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/strand_fields.h"

#include <algorithm>
#include <array>

#include "base/hash.h"

namespace pelage {
namespace {

/// Calls `store(strand, point)` with the position of each strand; `attributes` of the point are valid during
/// the call.
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

bool changes_by_strand(const Field& field) {
  const FieldDependence needs = field.dependence();
  return needs.surface || needs.attributes;
}

bool changes_along(const Field& field) {
  const FieldDependence needs = field.dependence();
  if (needs.along) return true;
  // The current colour of a strand may change along it.
  const std::vector<std::string> names =
      needs.attributes ? field.attribute_names() : std::vector<std::string>();
  return std::find(names.begin(), names.end(), "color") != names.end();
}

void multiply(const StrandRow& factor, size_t count, StrandRow& product) {
  for (size_t s = 0; s < count; ++s) product[s] *= factor[s];
}

}  // namespace

void evaluate(const Field& field, const StrandBatch& batch, float along, StrandRow& out) {
  if (!changes_by_strand(field)) {
    FieldPoint place;
    place.along = along;
    out.fill(field.value(place));
    return;
  }
  visit(field.dependence(), batch, along, 0,
        [&](size_t s, const FieldPoint& place) { out[s] = field.value(place); });
}

void evaluate_color(const Field& field, const StrandBatch& batch, int point, VectorRow& out) {
  if (!changes_by_strand(field)) {
    FieldPoint place;
    place.along = batch.along(point);
    const Rgb c = field.color(place);
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

template <class Row>
StrandField::Factors<Row>::Factors(const Field& field, const StrandBatch& batch) {
  const std::span<const Field> factors =
      field.factors().empty() ? std::span<const Field>(&field, 1) : field.factors();
  list.reserve(factors.size());
  for (const Field& factor : factors) {
    list.push_back({factor, changes_along(factor), changes_by_strand(factor), {}});
    if (list.back().changes_along) continue;
    if constexpr (std::is_same_v<Row, StrandRow>) {
      evaluate(factor, batch, 0, list.back().fixed);
    } else {
      evaluate_color(factor, batch, 0, list.back().fixed);
    }
  }
}

template struct StrandField::Factors<StrandRow>;
template struct StrandField::Factors<VectorRow>;

const StrandRow& StrandField::at(float along) {
  const size_t count = batch_.count;
  if (factors_.list.size() == 1) {
    if (!factors_.list[0].changes_along) return factors_.list[0].fixed;
    evaluate(factors_.list[0].field, batch_, along, row_);
    return row_;
  }
  // In the order of the product: the result is bit-identical to Field::value.
  std::fill_n(row_.begin(), count, 1.0f);
  StrandRow value;
  for (const Factor<StrandRow>& factor : factors_.list) {
    if (factor.changes_along) evaluate(factor.field, batch_, along, value);
    multiply(factor.changes_along ? value : factor.fixed, count, row_);
  }
  return row_;
}

void StrandColor::at(int point, VectorRow& out) {
  const size_t count = batch_.count;
  for (StrandRow& channel : out) std::fill_n(channel.begin(), count, 1.0f);
  VectorRow value;
  for (const StrandField::Factor<VectorRow>& factor : factors_.list) {
    if (factor.changes_along) evaluate_color(factor.field, batch_, point, value);
    for (size_t c = 0; c < 3; ++c) multiply(factor.changes_along ? value[c] : factor.fixed[c], count, out[c]);
  }
}

}  // namespace pelage
