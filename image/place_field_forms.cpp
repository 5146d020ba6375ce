// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "image/field_forms.h"
#include "image/field_mesh.h"
#include "image/field_places.h"

namespace pelage {
namespace {

struct BoxForm {
  V3f box{1};
  std::optional<V3f> center;
  float soft = 0;
  static const Schema<BoxForm>& schema();
};
struct SphereForm {
  float sphere = 1;
  std::optional<V3f> center;
  float soft = 0;
  static const Schema<SphereForm>& schema();
};
struct HeightForm {
  FieldDirection height;
  static const Schema<HeightForm>& schema();
};
struct SlopeForm {
  FieldDirection slope;
  static const Schema<SlopeForm>& schema();
};
struct DistanceKeys {
  std::optional<V3f> point;
  std::optional<FieldDirection> plane;
  std::vector<V3f> line;
  std::optional<FieldInput> boundary;
  AssetPath mesh;
  static const Schema<DistanceKeys>& schema();
};
struct DistanceForm {
  DistanceKeys distance;
  static const Schema<DistanceForm>& schema();
};

const Schema<BoxForm>& BoxForm::schema() {
  static const Schema<BoxForm> table = [] {
    Schema<BoxForm> s("box field", "1 inside a box along the axes of the rest space, 0 outside.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {box: [1.6, 1, 1.6], soft: 0.4}})");
    s.key("box", &BoxForm::box,
          {.unit = "scene units", .help = "Extents along x, y and z", .required = true});
    s.key("center", &BoxForm::center,
          {.unit = "scene units",
           .help = "Middle, in the skin's rest space",
           .default_text = "the middle of the skin's bounds"});
    s.key(
        "soft", &BoxForm::soft,
        {.unit = "scene units", .help = "Distance over which the field falls from 1 to 0 outside", .min = 0});
    return s;
  }();
  return table;
}

const Schema<SphereForm>& SphereForm::schema() {
  static const Schema<SphereForm> table = [] {
    Schema<SphereForm> s("sphere field", "1 inside a sphere, 0 outside.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {sphere: 0.8, soft: 0.4}})");
    s.set_picture("Left: constant length. Right: length from a sphere with a soft edge.");
    s.key("sphere", &SphereForm::sphere,
          {.unit = "scene units", .help = "Radius", .required = true, .min = 0});
    s.key("center", &SphereForm::center,
          {.unit = "scene units",
           .help = "Middle, in the skin's rest space",
           .default_text = "the middle of the skin's bounds"});
    s.key(
        "soft", &SphereForm::soft,
        {.unit = "scene units", .help = "Distance over which the field falls from 1 to 0 outside", .min = 0});
    return s;
  }();
  return table;
}

const Schema<HeightForm>& HeightForm::schema() {
  static const Schema<HeightForm> table = [] {
    Schema<HeightForm> s(
        "height field",
        "The height of the root: 0 at the bottom of the bounds of the skin's vertices, 1 at their top.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {height: z}})");
    s.set_picture("Left: constant length. Right: length that grows along z, from 0 to 1.");
    s.key("height", &HeightForm::height, {.help = "Direction in the skin's rest space", .required = true});
    return s;
  }();
  return table;
}

const Schema<SlopeForm>& SlopeForm::schema() {
  static const Schema<SlopeForm> table = [] {
    Schema<SlopeForm> s(
        "slope field",
        "The cosine of the angle between a direction and the normal of the skin at the root: 1 where the "
        "skin faces in this direction, 0 where it runs along it, -1 where it faces away.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {remap: {slope: y}, knots: [[0.7, 0.2], [1, 1]]}})");
    s.key("slope", &SlopeForm::slope, {.help = "Direction in the skin's rest space", .required = true});
    return s;
  }();
  return table;
}

const Schema<DistanceForm>& DistanceForm::schema() {
  static const Schema<DistanceForm> table = [] {
    Schema<DistanceForm> s(
        "distance field",
        "The distance of the root from a point, line, plane, mesh or boundary, in scene units.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {remap: {distance: {line: [[-1.8, 0.2, -1.2], [0, 0.6, 0], [1.8, 0.2, 1.2]]}}, knots: [[0.2, 0.05], [0.5, 0.5]]}})");
    s.set_picture("Left: constant length. Right: length that grows with the distance from a line.");
    s.key("distance", &DistanceForm::distance,
          {.help = "What the distance is measured from", .required = true});
    return s;
  }();
  return table;
}

const Schema<DistanceKeys>& DistanceKeys::schema() {
  static const Schema<DistanceKeys> table = [] {
    Schema<DistanceKeys> s(
        "distance of a field",
        "What a distance is measured from: one of `point`, `line`, `boundary` and `mesh`.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: {distance: {point: [0, 0, 1]}}})");
    s.key("point", &DistanceKeys::point,
          {.unit = "scene units", .help = "A point in the skin's rest space", .default_text = "none"});
    s.key("plane", &DistanceKeys::plane,
          {.help = "Normal of the plane through `point`: the distance from this plane, negative behind it",
           .default_text = "none"});
    s.key("line", &DistanceKeys::line,
          {.unit = "scene units",
           .help = "Points that a line joins, in the skin's rest space",
           .default_text = "none"});
    s.key("boundary", &DistanceKeys::boundary,
          {.help = "A field, such as a region: the distance from the line on the skin where it is 0.5. "
                   "Fields that jump between faces, such as `group`, have no such line",
           .default_text = "none"});
    s.key("mesh", &DistanceKeys::mesh,
          {.help = "OBJ file in the skin's rest space: the distance from its faces", .default_text = "none"});
    return s;
  }();
  return table;
}

bool read_box(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  BoxForm form;
  if (!BoxForm::schema().read(value, form, problems)) return false;
  if (!(std::min({form.box.x, form.box.y, form.box.z}) >= 0)) {
    problems.add(value.find("box")->position(), "the extents of a box must be at least 0");
    return false;
  }
  out = box_field({form.box, form.center, form.soft}, value.position());
  return true;
}

bool read_sphere(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  SphereForm form;
  if (!SphereForm::schema().read(value, form, problems)) return false;
  out = sphere_field({form.sphere, form.center, form.soft}, value.position());
  return true;
}

bool read_height(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  HeightForm form;
  if (!HeightForm::schema().read(value, form, problems)) return false;
  out = height_field(form.height, value.position());
  return true;
}

bool read_slope(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  SlopeForm form;
  if (!SlopeForm::schema().read(value, form, problems)) return false;
  out = slope_field(form.slope);
  return true;
}

bool read_distance(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  DistanceForm form;
  if (!DistanceForm::schema().read(value, form, problems)) return false;
  const DistanceKeys& keys = form.distance;
  const Value& block = *value.find("distance");
  const auto refuse = [&](const char* why) {
    problems.add(block.position(), why);
    return false;
  };
  const bool has_line = block.find("line") != nullptr, has_mesh = !keys.mesh.empty();
  if (keys.point.has_value() + has_line + keys.boundary.has_value() + has_mesh != 1)
    return refuse("a distance needs one of the keys `point`, `line`, `boundary` and `mesh`");
  if (keys.plane && !keys.point) return refuse("`plane` needs a `point` of the plane");
  if (has_line && keys.line.size() < 2) return refuse("a line needs at least 2 points");
  if (keys.boundary) {
    out = boundary_distance_field(keys.boundary->field, value.position());
  } else if (has_mesh) {
    out = mesh_distance_field(keys.mesh);
  } else {
    out = distance_field({keys.point, keys.plane, keys.line});
  }
  return true;
}

constexpr FieldForm kPlaceForms[] = {{"box", read_box, form_table<BoxForm>},
                                     {"sphere", read_sphere, form_table<SphereForm>},
                                     {"distance", read_distance, form_table<DistanceForm>},
                                     {"height", read_height, form_table<HeightForm>},
                                     {"slope", read_slope, form_table<SlopeForm>}};

}  // namespace

std::span<const FieldForm> place_field_forms() { return kPlaceForms; }

}  // namespace pelage
