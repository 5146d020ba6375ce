// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "image/field_forms.h"
#include "image/field_nodes.h"
#include "image/field_operations.h"

namespace pelage {
namespace {

const std::vector<FieldForm>& forms() {
  static const std::vector<FieldForm> all = [] {
    std::vector<FieldForm> list;
    for (const auto part : {plain_field_forms(), operation_field_forms(), place_field_forms(),
                            mesh_field_forms(), region_field_forms()})
      list.insert(list.end(), part.begin(), part.end());
    return list;
  }();
  return all;
}

/// The limits of the key, as floats inside them.
std::pair<float, float> float_limits(const KeyOptions& options) {
  constexpr float infinite = std::numeric_limits<float>::infinity();
  float low = static_cast<float>(options.min);
  if (static_cast<double>(low) < options.min || options.above_min) low = std::nextafter(low, infinite);
  float high = static_cast<float>(options.max);
  if (static_cast<double>(high) > options.max) high = std::nextafter(high, -infinite);
  return {low, high};
}

bool read_form(const Value& value, const KeyOptions& options, Field& out, Problems& problems) {
  for (const FieldForm& form : forms()) {
    if (!value.find(form.key)) continue;
    if (!form.read(value, options, out, problems)) return false;
    const bool limited = std::isfinite(options.min) || std::isfinite(options.max);
    if (limited) {
      const auto [low, high] = float_limits(options);
      out = clamped_field(out, low, high);
    }
    return true;
  }
  if (value.entries().empty()) {
    problems.add(value.position(),
                 "expected a kind of field, such as map, ramp or noise, got an empty block");
    return false;
  }
  std::vector<std::string> names;
  for (const FieldForm& form : forms()) names.push_back(form.key);
  const Value::Entry& entry = value.entries().front();
  problems.add(entry.key_position,
               "unknown kind of field " + quote(entry.key) +
                   (entry.key == "multiply" ? "; did you mean 'product'?" : suggest(entry.key, names)));
  return false;
}

}  // namespace

/// Adds a problem for a value outside the limits of the key, at its own position.
bool within_limits(const Value& value, const KeyOptions& options, Problems& problems) {
  Rgb ignored;
  return ValueReader<Rgb>::read(value, options, ignored, problems);
}

bool check_knots(const std::vector<RampKnot>& knots, const Value& list, const KeyOptions& limits,
                 Problems& problems) {
  bool good = true;
  if (knots.size() < 2) {
    problems.add(list.position(), fmt::format("a ramp needs at least 2 knots, got {}", knots.size()));
    good = false;
  }
  for (size_t i = 0; i < knots.size(); ++i) {
    const Value& knot = list.items()[i];
    good &= within_limits(knot.items()[1], limits, problems);
    if (i > 0 && knots[i].at < knots[i - 1].at) {
      problems.add(knot.position(), fmt::format("knots must be in rising order, got {} after {}", knots[i].at,
                                                knots[i - 1].at));
      good = false;
    }
  }
  return good;
}

bool ValueReader<Field>::read(const Value& value, const KeyOptions& options, Field& out, Problems& problems) {
  if (value.is_map()) return read_form(value, options, out, problems);
  const bool is_number = value.is_scalar() && !value.quoted() && parse_number(value.text());
  if (!is_number && !(value.is_list() && value.items().size() == 3)) {
    problems.add(
        value.position(),
        "expected a number, a colour [r, g, b], or a block with a kind of field, such as map, ramp or "
        "noise, got " +
            value.describe());
    return false;
  }
  Rgb constant;
  if (!ValueReader<Rgb>::read(value, options, constant, problems)) return false;
  out = Field(constant);
  return true;
}

std::vector<const SchemaInfo*> ValueReader<Field>::blocks() {
  std::vector<const SchemaInfo*> tables;
  for (const FieldForm& form : forms()) tables.push_back(&form.schema());
  return tables;
}

void ValueReader<Field>::visit_blocks(Value& value, const BlockVisitor& visit) {
  for (const FieldForm& form : forms()) {
    if (value.find(form.key)) return visit(value, form.schema());
  }
}

}  // namespace pelage
