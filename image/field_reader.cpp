// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "image/field_nodes.h"

namespace pelage {
namespace {

// The values of the blocks' own keys: {ramp: {...}}, {noise: {...}}, {attribute: name}, {product: [...]}.
struct RampForm {
  Ramp ramp;
  static const Schema<RampForm>& schema();
};
struct NoiseForm {
  Noise noise;
  static const Schema<NoiseForm>& schema();
};
struct AttributeForm {
  std::string attribute;
  static const Schema<AttributeForm>& schema();
};
struct Factors {
  std::vector<Field> list;
};
struct ProductForm {
  Factors product;
  static const Schema<ProductForm>& schema();
};

}  // namespace

// Lists no blocks: a field's blocks include this one, whose table would be requested while it is constructed.
template <>
struct ValueReader<Factors> {
  static bool read(const Value& value, const KeyOptions& options, Factors& out, Problems& problems) {
    return ValueReader<std::vector<Field>>::read(value, options, out.list, problems);
  }
  static std::string type_name() { return "list of field"; }
  static std::string print(const Factors& factors) {
    return ValueReader<std::vector<Field>>::print(factors.list);
  }
};

namespace {

const Schema<RampForm>& RampForm::schema() {
  static const Schema<RampForm> table = [] {
    Schema<RampForm> s("ramp field", "A value that changes along a strand or over the skin.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {ramp: {along: x, knots: [[-1.5, 0.15], [1.5, 1]]}}})");
    s.set_picture("Left: constant length. Right: length that grows along x.");
    s.key("ramp", &RampForm::ramp, {.help = "Axis and knots", .required = true});
    return s;
  }();
  return table;
}

const Schema<NoiseForm>& NoiseForm::schema() {
  static const Schema<NoiseForm> table = [] {
    Schema<NoiseForm> s("noise field", "A value that varies smoothly and randomly over the skin.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {noise: {frequency: 1, amplitude: 1.2, offset: 0.5}}})");
    s.set_picture("Left: constant length. Right: length from noise over the skin.");
    s.key("noise", &NoiseForm::noise, {.help = "Frequency and amplitude", .required = true});
    return s;
  }();
  return table;
}

const Schema<AttributeForm>& AttributeForm::schema() {
  static const Schema<AttributeForm> table = [] {
    Schema<AttributeForm> s("attribute field",
                            "The value of a strand attribute, such as `color`, `random` (one random number "
                            "per strand) or `clump` (one per clump).");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - clump: {spacing: 0.5, amount: 0.8}
      - color: {value: {attribute: clump}}   # one grey per clump)");
    s.set_picture("Left: one colour. Right: colour from the attribute `clump`, one grey per clump.");
    s.key("attribute", &AttributeForm::attribute, {.help = "Name of the attribute", .required = true});
    return s;
  }();
  return table;
}

const Schema<ProductForm>& ProductForm::schema() {
  static const Schema<ProductForm> table = [] {
    Schema<ProductForm> s("product field", "The product of several fields.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length:
          value:
            product:
              - {ramp: {along: x, knots: [[-1.5, 0.15], [1.5, 1]]}}
              - {noise: {frequency: 1.2, amplitude: 1.6, offset: 0.6}})");
    s.set_picture("Left: a ramp along x. Right: the same ramp multiplied by noise.");
    s.key("product", &ProductForm::product, {.help = "Fields to multiply", .required = true});
    return s;
  }();
  return table;
}

/// Adds a problem for a value outside the limits of the key, at its own position.
bool within_limits(const Value& value, const KeyOptions& options, Problems& problems) {
  Rgb ignored;
  return ValueReader<Rgb>::read(value, options, ignored, problems);
}

bool read_map(const Value& value, const KeyOptions& options, Field& out, Problems& problems) {
  MapForm form;
  if (!MapForm::schema().read(value, form, problems)) return false;
  V2f ignored;
  const Value* range = value.find("range");
  if (range && !ValueReader<V2f>::read(*range, options, ignored, problems)) return false;
  out = map_field(std::move(form));
  return true;
}

bool read_ramp(const Value& value, const KeyOptions& options, Field& out, Problems& problems) {
  RampForm form;
  if (!RampForm::schema().read(value, form, problems)) return false;
  const Value& list = *value.find("ramp")->find("knots");
  bool good = true;
  if (form.ramp.knots.size() < 2) {
    problems.add(list.position(),
                 fmt::format("a ramp needs at least 2 knots, got {}", form.ramp.knots.size()));
    good = false;
  }
  for (size_t i = 0; i < form.ramp.knots.size(); ++i) {
    const Value& knot = list.items()[i];
    good &= within_limits(knot.items()[1], options, problems);
    if (i > 0 && form.ramp.knots[i].at < form.ramp.knots[i - 1].at) {
      problems.add(knot.position(), fmt::format("knots must be in rising order, got {} after {}",
                                                form.ramp.knots[i].at, form.ramp.knots[i - 1].at));
      good = false;
    }
  }
  if (good) out = ramp_field(std::move(form.ramp));
  return good;
}

bool read_noise(const Value& value, const KeyOptions& options, Field& out, Problems& problems) {
  NoiseForm form;
  if (!NoiseForm::schema().read(value, form, problems)) return false;
  const Value* offset = value.find("noise")->find("offset");
  if (offset && !within_limits(*offset, options, problems)) return false;
  out = noise_field(form.noise);
  return true;
}

bool read_attribute_field(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  AttributeForm form;
  if (!AttributeForm::schema().read(value, form, problems)) return false;
  if (form.attribute.empty()) {
    problems.add(value.find("attribute")->position(), "expected the name of an attribute, got ''");
    return false;
  }
  out = attribute_field(std::move(form.attribute), value.find("attribute")->position());
  return true;
}

bool read_product(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  ProductForm form;
  if (!ProductForm::schema().read(value, form, problems)) return false;
  if (form.product.list.empty()) {
    problems.add(value.find("product")->position(), "a product needs at least 1 factor");
    return false;
  }
  out = product_field(std::move(form.product.list));
  return true;
}

using FormReader = bool (*)(const Value&, const KeyOptions&, Field&, Problems&);
struct Form {
  const char* key;
  FormReader read;
};
constexpr Form kForms[] = {{"map", read_map},
                           {"ramp", read_ramp},
                           {"noise", read_noise},
                           {"attribute", read_attribute_field},
                           {"product", read_product}};

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
  for (const Form& form : kForms) {
    if (!value.find(form.key)) continue;
    if (!form.read(value, options, out, problems)) return false;
    const bool limited = std::isfinite(options.min) || std::isfinite(options.max);
    if (limited) {
      const auto [low, high] = float_limits(options);
      out = clamped_field(out, low, high);
    }
    return true;
  }
  std::vector<std::string> names;
  for (const Form& form : kForms) names.push_back(form.key);
  if (value.entries().empty()) {
    problems.add(value.position(), "expected map, ramp, noise, attribute or product, got an empty block");
    return false;
  }
  const Value::Entry& entry = value.entries().front();
  problems.add(entry.key_position, "unknown kind of field " + quote(entry.key) + suggest(entry.key, names));
  return false;
}

}  // namespace

const Schema<MapForm>& MapForm::schema() {
  static const Schema<MapForm> table = [] {
    Schema<MapForm> s("map field",
                      "A value from an image, looked up by the texture coordinates of the root.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {map: length.png, channel: r, range: [0.1, 1]}})");
    s.set_picture("Left: constant length. Right: length from an image, short where it is dark.");
    s.key("map", &MapForm::map, {.help = "Image file of any common format", .required = true});
    s.key("channel", &MapForm::channel, {.help = "Channel to read as data. Without it the map is a colour"});
    s.key("range", &MapForm::range, {.help = "Values of the field where the image holds 0 and 1"});
    s.key("space", &MapForm::space,
          {.help = "Colour space of stored values. `auto`: integer formats are sRGB, unless a channel is "
                   "given; floating-point formats are linear"});
    s.key("wrap", &MapForm::wrap,
          {.help = "What the map is where texture coordinates are below 0 or above 1. `clamp`: its border; "
                   "`repeat`: the image again, which also mixes opposite borders"});
    return s;
  }();
  return table;
}

const Schema<Ramp>& Ramp::schema() {
  static const Schema<Ramp> table = [] {
    Schema<Ramp> s("ramp of a field", "A piecewise linear curve through knots, constant outside them.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - color:
          value: {ramp: {along: strand, knots: [[0, [0.08, 0.05, 0.03]], [1, [0.9, 0.6, 0.3]]]}})");
    s.key("along", &Ramp::along,
          {.help = "Axis of the curve. `strand`: 0 at the root, 1 at the tip; `x`, `y`, `z`: position of the "
                   "root in the skin's rest space; `u`, `v`: texture coordinates of the root"});
    s.key("knots", &Ramp::knots,
          {.help = "Knots [position, value] by increasing position. A value is a number or a colour. Two "
                   "knots at one position make a step",
           .required = true});
    return s;
  }();
  return table;
}

const Schema<Noise>& Noise::schema() {
  static const Schema<Noise> table = [] {
    Schema<Noise> s("noise of a field",
                    "offset + amplitude * gradient noise in [-1, 1] at the rest position of the root.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {noise: {frequency: 1, amplitude: 1.2, offset: 0.5, seed: 7}}})");
    s.key("frequency", &Noise::frequency,
          {.unit = "per scene unit", .help = "Noise cells per scene unit", .min = 0});
    s.key("amplitude", &Noise::amplitude, {.help = "Maximum deviation from the offset"});
    s.key("offset", &Noise::offset, {.help = "Mean value"});
    s.key("seed", &Noise::seed, {.help = "Seed of the noise", .min = 0});
    return s;
  }();
  return table;
}

bool ValueReader<RampKnot>::read(const Value& value, const KeyOptions&, RampKnot& out, Problems& problems) {
  if (!value.is_list() || value.items().size() != 2) {
    problems.add(value.position(), "expected a knot, [position, value], got " + value.describe());
    return false;
  }
  const bool at = ValueReader<float>::read(value.items()[0], {}, out.at, problems);
  return ValueReader<Rgb>::read(value.items()[1], {}, out.value, problems) && at;
}

std::string ValueReader<RampKnot>::print(const RampKnot& knot) {
  return fmt::format("[{}, {}]", ValueReader<float>::print(knot.at),
                     ValueReader<Field>::print(Field(knot.value)));
}

bool ValueReader<Field>::read(const Value& value, const KeyOptions& options, Field& out, Problems& problems) {
  if (value.is_map()) return read_form(value, options, out, problems);
  const bool is_number = value.is_scalar() && !value.quoted() && parse_number(value.text());
  if (!is_number && !(value.is_list() && value.items().size() == 3)) {
    problems.add(value.position(),
                 "expected a number, a colour [r, g, b], or a block with map, ramp, noise, "
                 "attribute or product, got " +
                     value.describe());
    return false;
  }
  Rgb constant;
  if (!ValueReader<Rgb>::read(value, options, constant, problems)) return false;
  out = Field(constant);
  return true;
}

std::vector<const SchemaInfo*> ValueReader<Field>::blocks() {
  return {&MapForm::schema(), &RampForm::schema(), &NoiseForm::schema(), &AttributeForm::schema(),
          &ProductForm::schema()};
}

void ValueReader<Field>::visit_blocks(Value& value, const BlockVisitor& visit) {
  const std::vector<const SchemaInfo*> tables = blocks();
  for (size_t i = 0; i < tables.size(); ++i) {
    if (value.find(kForms[i].key)) visit(value, *tables[i]);
  }
}

}  // namespace pelage
