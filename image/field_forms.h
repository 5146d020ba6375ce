// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "base/value_readers.h"
#include "image/field.h"

// The blocks of a scene that describe fields, by the key that names their kind.

namespace pelage {

struct RampKnot;

/// One kind of field.
struct FieldForm {
  const char* key;
  bool (*read)(const Value&, const KeyOptions& limits, Field& out, Problems&);
  const SchemaInfo& (*schema)();
};

/// Returns the table of a form.
template <class Form>
const SchemaInfo& form_table() {
  return Form::schema();
}

std::span<const FieldForm> plain_field_forms();      ///< map, ramp, noise, attribute
std::span<const FieldForm> operation_field_forms();  ///< computed from other fields
std::span<const FieldForm> place_field_forms();      ///< shapes in rest space, height, slope
std::span<const FieldForm> mesh_field_forms();       ///< what the mesh of a skin provides
std::span<const FieldForm> region_field_forms();     ///< regions of the scene, by name

/// A field inside a field. Its table is not listed under the enclosing block: a field's tables include this
/// block, and would be requested while they are constructed.
struct FieldInput {
  Field field;
};
template <>
struct ValueReader<FieldInput> {
  static bool read(const Value& value, const KeyOptions& options, FieldInput& out, Problems& problems) {
    return ValueReader<Field>::read(value, options, out.field, problems);
  }
  static std::string type_name() { return "field"; }
  static std::string print(const FieldInput& input) { return ValueReader<Field>::print(input.field); }
  static void visit_blocks(Value& value, const BlockVisitor& visit) {
    ValueReader<Field>::visit_blocks(value, visit);
  }
};

/// Several such fields.
struct FieldInputs {
  std::vector<Field> list;
};
template <>
struct ValueReader<FieldInputs> {
  static bool read(const Value& value, const KeyOptions& options, FieldInputs& out, Problems& problems) {
    return ValueReader<std::vector<Field>>::read(value, options, out.list, problems);
  }
  static std::string type_name() { return "list of field"; }
  static std::string print(const FieldInputs& inputs) {
    return ValueReader<std::vector<Field>>::print(inputs.list);
  }
  static void visit_blocks(Value& value, const BlockVisitor& visit) {
    ValueReader<std::vector<Field>>::visit_blocks(value, visit);
  }
};

/// Adds a problem unless a curve has at least 2 knots, by rising position, and values within the limits of
/// the key. `list`: the knots in the scene.
bool check_knots(const std::vector<RampKnot>& knots, const Value& list, const KeyOptions& limits,
                 Problems& problems);
/// Adds a problem for a value outside the limits of the key, at its own position.
bool within_limits(const Value& value, const KeyOptions& options, Problems& problems);

}  // namespace pelage
