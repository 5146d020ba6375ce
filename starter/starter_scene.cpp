// SPDX-License-Identifier: Apache-2.0
#include "starter/starter_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/value_readers.h"
#include "starter/animal_coat.h"

namespace pelage {
namespace {

std::string number(double value) { return fmt::format("{:.3g}", value); }
/// A position: far from the origin, three digits would move it.
std::string place(double value) { return fmt::format("{:.6g}", value); }

template <class Print>
std::string list(const V3f& v, const Print& print) {
  return fmt::format("[{}, {}, {}]", print(v.x), print(v.y), print(v.z));
}
std::string vector(V3f v) {
  for (int i = 0; i < 3; ++i) v[i] = std::round(v[i] * 100) / 100 + 0.0f;  // + 0: no -0
  return list(v, number);
}
std::string color(const Rgb& c) { return list(V3f(c.x, c.y, c.z), number); }

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// In double quotes, where YAML has escapes for control characters: a line break in the name of a file must
/// not begin a line of the scene.
std::string escaped(const std::string& path) {
  std::string text = "\"";
  for (const char c : path) {
    if (is_control(c))
      text += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    else
      text += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  }
  return text + "\"";
}

/// A path in quotes for YAML, where it needs them.
std::string quoted(const std::string& path) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '/' || c == '.' || c == '-';
  };
  const bool starts_plain = !path.empty() && path[0] != '-' && path[0] != '.';
  if (starts_plain && std::all_of(path.begin(), path.end(), plain)) return path;
  if (std::any_of(path.begin(), path.end(), is_control)) return escaped(path);
  std::string text = "'";
  for (const char c : path) text += c == '\'' ? "''" : std::string(1, c);
  return text + "'";
}

/// The directions of a body, as a person facing the same way has them.
struct BodyAxes {
  V3f forward, up, right;
  explicit BodyAxes(const BodyShape& shape)
      : forward(shape.facing.vector()), up(shape.up.vector()), right(forward.cross(up)) {}
  V3f at(float f, float r, float u) const { return f * forward + r * right + u * up; }
};

/// A ramp over the body along a direction: `knots` from 0 at its end to 1 at its beginning.
std::string ramp(const BodyShape& shape, AxisDirection direction,
                 std::vector<std::pair<float, float>> knots) {
  const float low = shape.box.min[direction.axis], size = shape.extent(direction);
  if (direction.sign < 0) {
    std::reverse(knots.begin(), knots.end());
    for (auto& [at, value] : knots) at = 1 - at;
  }
  std::string text;
  for (const auto& [at, value] : knots)
    text += fmt::format("{}[{}, {}]", text.empty() ? "" : ", ", place(low + at * size), number(value));
  return fmt::format("{{ramp: {{along: {}, knots: [{}]}}}}", "xyz"[direction.axis], text);
}

std::string head_text(const StarterScene& starter) {
  const BodyShape& shape = starter.shape;
  const BodyAxes axes(shape);
  // Long bodies are seen more from the side than upright ones.
  const V3f view = shape.is_upright() ? axes.at(1, 0.6f, 0.25f) : axes.at(0.8f, 1, 0.35f);
  return fmt::format(
      R"(pelage: 1
# A {} coat on {}, by `pelage new`. The body is {} long, {} high and {} wide.
# It faces {} and its top is {}; if that is wrong: pelage new ... --facing {} (or --up)
units: {{meters_per_unit: {}}}   # a guess from the size of the body; the picture does not depend on it
camera: {{frame: body, position: {}, look_at: [0, 0, 0], up: {}, fov: 24}}   # `frame` finds the distance
image: {{width: 960, height: 540}}

skins:
  body: {{mesh: {}, scheme: {}}}
)",
      starter.look.name, quoted(starter.mesh), number(shape.extent(shape.facing)),
      number(shape.extent(shape.up)), number(shape.box.size()[3 - shape.facing.axis - shape.up.axis]),
      shape.facing.name(), shape.up.name(), shape.facing.opposite().name(), number(shape.meters_per_unit),
      vector(view), vector(axes.up), quoted(starter.mesh),
      ValueReader<SubdivisionScheme>::print(shape.scheme));
}

/// Shorter hair on the head and the feet.
std::string length_lines(const BodyShape& shape) {
  if (shape.is_upright()) {
    return fmt::format("      - length: {{scale: {}}}   # shorter at the bottom and the top\n",
                       ramp(shape, shape.up, {{0, 0.6f}, {0.25f, 1}, {0.7f, 1}, {0.95f, 0.6f}}));
  }
  return fmt::format(
      "      - length: {{scale: {}}}   # from the tail to the face\n"
      "      - length: {{scale: {}}}   # from the feet up\n",
      ramp(shape, shape.facing, {{0, 1}, {0.7f, 1}, {0.95f, 0.45f}}),
      ramp(shape, shape.up, {{0, 0.45f}, {0.25f, 0.65f}, {0.45f, 1}}));
}

/// Strands per area: 1 on the scalp, 0 elsewhere.
std::string scalp_text(const BodyShape& shape) {
  const Scalp& scalp = shape.scalp;
  const float up = shape.extent(shape.up), forward = scalp.slope * shape.extent(shape.facing);
  const BodyAxes axes(shape);
  const auto low = [&](const V3f& axis) {
    return std::min(axis.dot(shape.box.min), axis.dot(shape.box.max));
  };
  const float at = scalp.height - low(axes.up) + scalp.slope * low(axes.forward);
  return fmt::format(
      "    density: {{threshold: {{add: [{}, {}]}}, at: {}, width: {}}}   # the scalp: above a plane from "
      "the nape to the forehead\n",
      ramp(shape, shape.up, {{0, 0}, {1, up}}), ramp(shape, shape.facing, {{0, 0}, {1, -forward}}), place(at),
      number(0.04 * up));
}

std::string coat_text(const StarterScene& starter) {
  const CoatLook& look = starter.look;
  const BodyShape& shape = starter.shape;
  const BodyAxes axes(shape);
  const bool scalp = look.animal && look.animal->scalp;
  const float area = scalp ? shape.scalp.area : shape.area;
  const float size = sphere_diameter(area), length = look.length * size;
  const int strands = starter.strands > 0 ? starter.strands : look.strands;
  // Strands taper, vary and are shorter here and there: half of root times length is a strand's mean area.
  const float wanted = 2 * look.coverage * area / (float(strands) * length);
  const float width = std::min(wanted, length / 12);  // wider, they are needles
  const V3f down = shape.is_upright() ? axes.at(-0.4f, 0, -1) : axes.at(-1, 0, -look.droop);
  std::string text = fmt::format(
      R"(
grooms:
  coat:
    skin: body
    strands: {}   # with twice as many, halve the width
{}    points: {}
    operators:
      - length: {{value: {}, variation: 0.4}}
{}      - comb: {{direction: {}, lift: {}, curve: 0.4}}   # along the body; lift 0 is flat, 1 upright
)",
      strands, scalp ? scalp_text(shape) : "", look.points, number(length), scalp ? "" : length_lines(shape),
      vector(down), number(look.lift));
  if (look.bend > 0)
    text += fmt::format("      - bend: {{direction: {}, angle: {}, variation: 0.5}}   # gravity\n",
                        vector(-axes.up), number(look.bend));
  text += fmt::format("      - noise: {{amplitude: {}, frequency: {}}}   # neighbours wander together\n",
                      number(look.waves * length), number(2.5 / size));
  text += fmt::format(
      "      - clump: {{spacing: {}, amount: {}, profile: 0.9, variation: 0.5, strays: 0.15, levels: "
      "[{{spacing: {}, amount: {}}}]}}\n",
      number(look.clump * size), number(look.clumped), number(0.35 * look.clump * size),
      number(look.clumped));
  if (look.curl > 0)
    text += fmt::format("      - curl: {{radius: {}, turns: {}, angle_variation: 0.15, start: 0.3}}\n",
                        number(look.curl * length), number(look.turns));
  else  // straight hair is not as straight as a needle: each strand bows in its own direction
    text += fmt::format(
        "      - curl: {{radius: {}, turns: 0.7, start: 0.6}}   # every strand bows its own way\n",
        number(0.03f * length));
  text += fmt::format("      - frizz: {{amplitude: {}, frequency: 2}}\n", number(look.frizz * length));
  text += fmt::format("      - width: {{root: {}, tip: {}, profile: 2.5, variation: 0.3}}\n", number(width),
                      number(0.2 * width));
  const std::string knots = look.animal ? look.animal->knots
                                        : fmt::format("[[0, {}], [0.6, {}], [1, {}]]", color(look.root),
                                                      color(look.tip * 0.8f), color(look.tip));
  if (knots.empty()) return text;  // the material has pigments
  text += fmt::format(
      R"(      - color:
          variation: 0.25
          value: {{product: [{{ramp: {{along: strand, knots: {}}}}}, {{noise: {{frequency: {}, amplitude: 0.3, offset: 1}}}}]}}   # root to tip, in patches
)",
      knots, number(3 / size));
  return text;
}

std::string look_text(const StarterScene& starter) {
  const CoatLook& look = starter.look;
  const BodyShape& shape = starter.shape;
  const BodyAxes axes(shape);
  const V3f middle = shape.box.center();
  const float radius = 0.5f * shape.box.size().length();
  const auto at = [&](float f, float r, float u) { return list(middle + radius * axes.at(f, r, u), place); };
  const std::string target = list(middle, place);
  const std::string up = shape.up == AxisDirection{1, 1} ? "" : fmt::format(", up: {}", vector(axes.up));
  return fmt::format(
      R"(
materials:
  hide: {{model: lambert, color: {}}}
  fur: {}

characters:
  animal: {{parts: [{{skin: body, material: hide, grooms: {{coat: fur}}}}]}}

lights:   # sizes and distances are in proportion to the body
  key: {{type: rectangle, position: {}, look_at: {}{}, size: [{}, {}], radiance: [1, 0.94, 0.86], intensity: 5}}
  rim: {{type: rectangle, position: {}, look_at: {}{}, size: [{}, {}], radiance: [0.9, 0.95, 1], intensity: 9}}
  sky: {{type: environment, radiance: [0.62, 0.7, 0.8], intensity: 0.5}}

render: {{lod: {{enabled: false}}}}   # one animal from near: every hair
)",
      color(look.root * 0.8f),
      look.animal ? fmt::format("{{preset: {}}}", look.name)
                  : "{model: cone-shell, color: {attribute: color}}",
      at(2.2f, -0.4f, 2.2f), target, up, number(2 * radius), number(2 * radius), at(-2.4f, -1.6f, 1.8f),
      target, up, number(2.5f * radius), number(1.5f * radius));
}

}  // namespace

std::string starter_scene_text(const StarterScene& starter) {
  return head_text(starter) + coat_text(starter) + look_text(starter);
}

}  // namespace pelage
