// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/strand_fields.h"

#include <algorithm>
#include <array>

#include "base/hash.h"
#include "image/field_node.h"

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
    if (needs.normal) place.normal = vector_at(batch.rest.normal, s);
    if (needs.face) {
      place.face = batch.face[s];
      place.face_uv = {batch.face_u[s], batch.face_v[s]};
    }
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

}  // namespace

bool changes_along(const Field& field) {
  const FieldDependence needs = field.dependence();
  if (needs.along) return true;
  // The current colour of a strand may change along it.
  const std::vector<std::string> names =
      needs.attributes ? field.attribute_names() : std::vector<std::string>();
  return std::find(names.begin(), names.end(), "color") != names.end();
}

namespace {

/// The channels of a row: one number or a colour per strand.
std::span<StrandRow> channels(StrandRow& row) { return {&row, 1}; }
std::span<StrandRow> channels(VectorRow& row) { return row; }
std::span<const StrandRow> channels(const StrandRow& row) { return {&row, 1}; }
std::span<const StrandRow> channels(const VectorRow& row) { return row; }

Rgb value_of(const Field& field, const FieldPoint& place, const VectorRow&) { return field.color(place); }
Rgb value_of(const Field& field, const FieldPoint& place, const StrandRow&) {
  return Rgb(field.value(place));
}

/// Computes a field from the rows of its inputs. The result is bit-identical to Field::value and
/// Field::color.
template <class Row>
void combine(const Field& field, std::span<const Row* const> inputs, size_t count, Row& out) {
  std::vector<const float*> rows(inputs.size());
  for (size_t c = 0; c < channels(out).size(); ++c) {
    for (size_t i = 0; i < inputs.size(); ++i) rows[i] = channels(*inputs[i])[c].data();
    field.node().combine(rows, static_cast<int>(c), count, channels(out)[c].data());
  }
}

/// Evaluates a field at position `along` of the strands, where the attribute "color" is that at `point`.
template <class Row>
void evaluate_rows(const Field& field, const StrandBatch& batch, float along, int point, Row& out) {
  if (!changes_by_strand(field)) {
    FieldPoint place;
    place.along = along;
    const Rgb value = value_of(field, place, out);
    for (size_t c = 0; c < channels(out).size(); ++c) channels(out)[c].fill(value[static_cast<int>(c)]);
  } else if (!field.inputs().empty()) {
    std::vector<Row> values(field.inputs().size());
    std::vector<const Row*> inputs;
    for (size_t i = 0; i < values.size(); ++i) {
      evaluate_rows(field.inputs()[i], batch, along, point, values[i]);
      inputs.push_back(&values[i]);
    }
    combine<Row>(field, inputs, batch.count, out);
  } else {
    visit(field.dependence(), batch, along, point, [&](size_t s, const FieldPoint& place) {
      const Rgb value = value_of(field, place, out);
      for (size_t c = 0; c < channels(out).size(); ++c) channels(out)[c][s] = value[static_cast<int>(c)];
    });
  }
}

}  // namespace

void evaluate(const Field& field, const StrandBatch& batch, float along, StrandRow& out) {
  evaluate_rows(field, batch, along, 0, out);
}

void evaluate_color(const Field& field, const StrandBatch& batch, int point, VectorRow& out) {
  evaluate_rows(field, batch, batch.along(point), point, out);
}

template <class Row>
FieldRows<Row>::FieldRows(const Field& field, const StrandBatch& batch)
    : field_(field), batch_(batch), changes_along_(changes_along(field)) {
  if (!changes_along_) {
    evaluate_rows(field, batch, 0, 0, row_);
  } else if (changes_by_strand(field)) {
    inputs_.reserve(field.inputs().size());
    for (const Field& input : field.inputs()) inputs_.emplace_back(input, batch);
  }
}

template <class Row>
const Row& FieldRows<Row>::at(float along, int point) {
  if (!changes_along_) return row_;
  if (inputs_.empty()) {
    evaluate_rows(field_, batch_, along, point, row_);
    return row_;
  }
  std::vector<const Row*> rows;
  for (FieldRows& input : inputs_) rows.push_back(&input.at(along, point));
  combine<Row>(field_, rows, batch_.count, row_);
  return row_;
}

template class FieldRows<StrandRow>;
template class FieldRows<VectorRow>;

}  // namespace pelage
