// SPDX-License-Identifier: Apache-2.0
#include "image/field_forms.h"
#include "image/field_mesh.h"

namespace pelage {

enum class VertexChannel { kR, kG, kB };
template <>
struct EnumNames<VertexChannel> {
  static constexpr const char* names[] = {"r", "g", "b"};
};

namespace {

struct VertexColorForm {
  std::optional<VertexChannel> channel;
  static const Schema<VertexColorForm>& schema();
};
struct GroupForm {
  std::string group;
  static const Schema<GroupForm>& schema();
};
struct CurvatureForm {
  float curvature = 1;
  static const Schema<CurvatureForm>& schema();
};

const Schema<VertexColorForm>& VertexColorForm::schema() {
  static const Schema<VertexColorForm> table = [] {
    Schema<VertexColorForm> s(
        "vertex_color field",
        "The colour of the vertices of the mesh: three more numbers, from 0 to 1, in the v lines of its OBJ "
        "file. They are linear colours, interpolated over each face of the mesh.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - color: {value: {vertex_color: }}
      - length: {value: {vertex_color: r}})");
    s.key("vertex_color", &VertexColorForm::channel,
          {.help = "Channel to read as data. Without a value, the field is a colour",
           .default_text = "colour"});
    return s;
  }();
  return table;
}

const Schema<GroupForm>& GroupForm::schema() {
  static const Schema<GroupForm> table = [] {
    Schema<GroupForm> s("group field",
                        "1 on the faces of one group of the mesh, 0 elsewhere. The groups are the names of "
                        "the g, o and usemtl lines of its OBJ file.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: 0.3, mask: {group: ears}})");
    s.key("group", &GroupForm::group, {.help = "Name of the group", .required = true});
    return s;
  }();
  return table;
}

const Schema<CurvatureForm>& CurvatureForm::schema() {
  static const Schema<CurvatureForm> table = [] {
    Schema<CurvatureForm> s("curvature field",
                            "The mean curvature of the skin: > 0 on a hill, < 0 in a fold, 1 / r on a ball "
                            "of radius r, times a length.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {scale: {remap: {curvature: 1}, knots: [[-1, 1.5], [1, 0.5]]}})");
    s.key("curvature", &CurvatureForm::curvature,
          {.unit = "scene units", .help = "Length by which the curvature is multiplied", .required = true});
    return s;
  }();
  return table;
}

bool read_vertex_color(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  VertexColorForm form;
  if (!VertexColorForm::schema().read(value, form, problems)) return false;
  out = vertex_color_field(form.channel ? std::optional(static_cast<int>(*form.channel)) : std::nullopt,
                           value.position());
  return true;
}

bool read_group(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  GroupForm form;
  if (!GroupForm::schema().read(value, form, problems)) return false;
  out = group_field(form.group, value.find("group")->position());
  return true;
}

bool read_curvature(const Value& value, const KeyOptions&, Field& out, Problems& problems) {
  CurvatureForm form;
  if (!CurvatureForm::schema().read(value, form, problems)) return false;
  out = curvature_field(form.curvature, value.position());
  return true;
}

constexpr FieldForm kMeshForms[] = {{"vertex_color", read_vertex_color, form_table<VertexColorForm>},
                                    {"group", read_group, form_table<GroupForm>},
                                    {"curvature", read_curvature, form_table<CurvatureForm>}};

}  // namespace

std::span<const FieldForm> mesh_field_forms() { return kMeshForms; }

}  // namespace pelage
