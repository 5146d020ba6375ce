// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "image/field_forms.h"
#include "image/field_nodes.h"
#include "image/map_field.h"
#include "image/udim.h"

namespace pelage {
namespace {

// The values of the blocks' own keys: {ramp: {...}}, {noise: {...}}, {attribute: name}.
struct RampForm {
  Ramp ramp;
  static const Schema<RampForm>& schema();
};
struct NoiseForm {
  NoiseShape noise;
  static const Schema<NoiseForm>& schema();
};
struct AttributeForm {
  std::string attribute;
  static const Schema<AttributeForm>& schema();
};

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

bool read_map(const Value& value, const KeyOptions& options, Field& out, Problems& problems) {
  MapForm form;
  if (!MapForm::schema().read(value, form, problems)) return false;
  V2f ignored;
  const Value* range = value.find("range");
  if (range && !ValueReader<V2f>::read(*range, options, ignored, problems)) return false;
  const auto refuse = [&](const char* key, const std::string& why) {
    problems.add(value.find(key)->position(), why);
    return false;
  };
  const bool projected = form.projection != MapProjection::kTexture,
             placed = projected && form.projection != MapProjection::kFace;
  if (form.axis && (!placed || form.projection == MapProjection::kTriplanar))
    return refuse("axis", "`axis` needs `projection: planar`, `cylinder` or `sphere`");
  for (const char* key : {"center", "size"}) {
    if (value.find(key) && !placed)
      return refuse(key,
                    fmt::format("`{}` needs `projection: planar`, `triplanar`, `cylinder` or `sphere`", key));
  }
  if (form.size && !(std::min({form.size->x, form.size->y, form.size->z}) > 0))
    return refuse("size", "each extent of `size` must be > 0");
  if (has_tiles(form.map.path) && projected)
    return refuse("projection", "a map of UDIM tiles is looked up by texture coordinates only");
  if (has_tiles(form.map.path) && value.find("wrap"))
    return refuse("wrap", "`wrap` has no effect on a map of UDIM tiles, which has no border");
  out = map_field(std::move(form));
  return true;
}

bool read_ramp(const Value& value, const KeyOptions& options, Field& out, Problems& problems) {
  RampForm form;
  if (!RampForm::schema().read(value, form, problems)) return false;
  if (!check_knots(form.ramp.knots, *value.find("ramp")->find("knots"), options, problems)) return false;
  out = ramp_field(std::move(form.ramp));
  return true;
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

constexpr FieldForm kPlainForms[] = {{"map", read_map, form_table<MapForm>},
                                     {"ramp", read_ramp, form_table<RampForm>},
                                     {"noise", read_noise, form_table<NoiseForm>},
                                     {"attribute", read_attribute_field, form_table<AttributeForm>}};

}  // namespace

std::span<const FieldForm> plain_field_forms() { return kPlainForms; }

const Schema<MapForm>& MapForm::schema() {
  static const Schema<MapForm> table = [] {
    Schema<MapForm> s(
        "map field",
        "A value from an image, looked up by the texture coordinates of the root, or by its position.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {map: length.png, channel: r, range: [0.1, 1], projection: planar, axis: y, size: [1.5, 1, 1.5], wrap: repeat}})");
    s.set_picture(
        "Left: length from an image by texture coordinates, short where it is dark. Right: the same image "
        "with `projection: planar`, seen along y and repeated.");
    s.key("map", &MapForm::map,
          {.help =
               "Image file of any common format. `<UDIM>` or `%(UDIM)d` in the name is the number of a UDIM "
               "tile: 1001 for texture coordinates from 0 to 1, 1002 for u from 1 to 2, 1011 for v from 1 "
               "to 2",
           .required = true});
    s.key("channel", &MapForm::channel, {.help = "Channel to read as data. Without it the map is a colour"});
    s.key("range", &MapForm::range, {.help = "Values of the field where the image holds 0 and 1"});
    s.key("space", &MapForm::space,
          {.help = "Colour space of stored values. `auto`: integer formats are sRGB, unless a channel is "
                   "given; floating-point formats are linear"});
    s.key("wrap", &MapForm::wrap,
          {.help =
               "What the map is outside its image, where coordinates are below 0 or above 1. `clamp`: its "
               "border; `repeat`: the image again, which also mixes opposite borders; `black`: the value of "
               "the field where the image holds 0"});
    s.key("projection", &MapForm::projection,
          {.help =
               "Where the image lies on the skin at rest. `texture`: by texture coordinates; `planar`: seen "
               "along `axis`; `triplanar`: seen along x, y and z, mixed by the skin's normal; `cylinder` and "
               "`sphere`: wound around `axis`; `face`: the whole image on each face of the mesh"});
    s.key("axis", &MapForm::axis,
          {.help = "Axis of a projection", .default_text = "z for `planar`, y for `cylinder` and `sphere`"});
    s.key("center", &MapForm::center,
          {.unit = "scene units",
           .help = "Middle of the image in the skin's rest space",
           .default_text = "the middle of the skin's bounds"});
    s.key("size", &MapForm::size,
          {.unit = "scene units",
           .help = "Extents of the image along x, y and z",
           .default_text = "the size of the skin's bounds"});
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

const Schema<NoiseShape>& NoiseShape::schema() {
  static const Schema<NoiseShape> table = [] {
    Schema<NoiseShape> s("noise of a field",
                         "offset + amplitude * gradient noise in [-1, 1] at the rest position of the root.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {noise: {frequency: 1, amplitude: 1.2, offset: 0.5, seed: 7}}})");
    s.key("frequency", &NoiseShape::frequency,
          {.unit = "per scene unit", .help = "Noise cells per scene unit", .min = 0});
    s.key("amplitude", &NoiseShape::amplitude, {.help = "Maximum deviation from the offset"});
    s.key("offset", &NoiseShape::offset, {.help = "Mean value"});
    s.key("seed", &NoiseShape::seed, {.help = "Seed of the noise", .min = 0});
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

}  // namespace pelage
