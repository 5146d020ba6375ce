// SPDX-License-Identifier: Apache-2.0
#include "image/field_mesh.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "base/check.h"
#include "base/nearest_name.h"
#include "image/field_places.h"

namespace pelage {
namespace {

using ValuesPtr = std::shared_ptr<const SkinValues>;

/// Values that the skin computes when the field is loaded. A `Source` has
///   ValuesPtr load(const FieldSources&) const;
///   std::string print() const;
///   std::pair<float, float> range() const;                   // before it is loaded
///   FieldDependence dependence() const;
/// and names its files and the maps of its own fields.
template <class Source>
struct MeshNode final : Field::Node {
  explicit MeshNode(Source s, ValuesPtr v = nullptr) : source(std::move(s)), values(std::move(v)) {}

  Rgb color(const FieldPoint& p) const override {
    PELAGE_CHECK(values != nullptr);
    return values->at(p);
  }
  float value(const FieldPoint& p) const override { return color(p).x; }
  FieldDependence dependence() const override { return source.dependence(); }
  std::pair<float, float> range() const override { return values ? values->range() : source.range(); }
  std::string print() const override { return source.print(); }
  void collect_maps(std::vector<AssetPath>& maps, bool by_texture) const override {
    if constexpr (requires { source.region; }) source.region.node().collect_maps(maps, by_texture);
  }
  void collect_files(std::vector<std::filesystem::path>& files) const override {
    if constexpr (requires { source.region; }) source.region.node().collect_files(files);
    if constexpr (requires { source.mesh; }) files.push_back(source.mesh.path);
  }
  std::shared_ptr<const Node> with_textures(const FieldSources& sources) const override {
    return std::make_shared<MeshNode>(source, source.load(sources));
  }

  Source source;
  ValuesPtr values;
};

/// Other values, times a number or reduced to one channel.
struct ChangedValues final : SkinValues {
  ChangedValues(ValuesPtr v, float s, std::optional<int> c) : values(std::move(v)), scale(s), channel(c) {}
  Rgb at(const FieldPoint& p) const override {
    const Rgb c = values->at(p);
    return channel ? Rgb(c[*channel]) * scale : c * scale;
  }
  std::pair<float, float> range() const override {
    const auto [low, high] = values->range();
    return std::minmax({low * scale, high * scale});
  }
  ValuesPtr values;
  float scale;
  std::optional<int> channel;
};

constexpr FieldDependence kOnFaces{.surface = true, .face = true};
constexpr std::pair<float, float> kUnit{0.0f, 1.0f};

struct VertexColors {
  ValuesPtr load(const FieldSources& sources) const {
    const FieldSkin& skin = skin_for("vertex_color", position, sources);
    ValuesPtr colors = skin.vertex_colors();
    if (!colors) {
      throw Error(ErrorKind::kInput, position,
                  "the mesh of " + skin.name() +
                      " has no vertex colours: in an OBJ file, they are three more numbers from 0 to 1 in "
                      "each v line");
    }
    return channel ? std::make_shared<const ChangedValues>(colors, 1.0f, channel) : colors;
  }
  std::string print() const {
    return channel ? fmt::format("{{vertex_color: {}}}", "rgb"[*channel]) : "{vertex_color: }";
  }
  std::pair<float, float> range() const { return kUnit; }
  FieldDependence dependence() const { return kOnFaces; }

  std::optional<int> channel;
  SourcePosition position;
};

struct Group {
  ValuesPtr load(const FieldSources& sources) const {
    const FieldSkin& skin = skin_for("group", position, sources);
    const std::vector<std::string> names = skin.groups();
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      throw Error(ErrorKind::kInput, position,
                  "the mesh of " + skin.name() + " has no group " + quote(name) +
                      (names.empty() ? "; it has none" : suggest(name, names)));
    }
    return skin.group(name);
  }
  std::string print() const { return "{group: " + name + "}"; }
  std::pair<float, float> range() const { return kUnit; }
  FieldDependence dependence() const { return kOnFaces; }

  std::string name;
  SourcePosition position;
};

struct Curvature {
  ValuesPtr load(const FieldSources& sources) const {
    return std::make_shared<const ChangedValues>(skin_for("curvature", position, sources).curvature(), scale,
                                                 std::nullopt);
  }
  std::string print() const { return fmt::format("{{curvature: {}}}", print_number(scale)); }
  std::pair<float, float> range() const { return {-1e30f, 1e30f}; }
  FieldDependence dependence() const { return kOnFaces; }

  float scale;
  SourcePosition position;
};

struct Boundary {
  ValuesPtr load(const FieldSources& sources) const {
    const FieldSkin& skin = skin_for("the distance from a boundary", position, sources);
    ValuesPtr distance = skin.distance_to_boundary(region.with_textures(sources));
    if (distance) return distance;
    throw Error(ErrorKind::kInput, position,
                "the field has no boundary on " + skin.name() + ": it is nowhere 0.5");
  }
  std::string print() const { return "{distance: {boundary: " + region.node().print() + "}}"; }
  std::pair<float, float> range() const { return {0.0f, 1e30f}; }
  FieldDependence dependence() const { return {.surface = true, .rest = true}; }

  Field region;
  SourcePosition position;
};

struct MeshDistance {
  ValuesPtr load(const FieldSources& sources) const {
    return skin_for("the distance from a mesh", mesh.position, sources).distance_to_mesh(mesh);
  }
  std::string print() const { return "{distance: {mesh: " + mesh.path.string() + "}}"; }
  std::pair<float, float> range() const { return {0.0f, 1e30f}; }
  FieldDependence dependence() const { return {.surface = true, .rest = true}; }

  AssetPath mesh;
};

template <class Source>
Field mesh_field(Source source) {
  return Field(std::make_shared<MeshNode<Source>>(std::move(source)));
}

}  // namespace

Field vertex_color_field(std::optional<int> channel, SourcePosition position) {
  return mesh_field(VertexColors{channel, std::move(position)});
}
Field group_field(std::string group, SourcePosition position) {
  return mesh_field(Group{std::move(group), std::move(position)});
}
Field curvature_field(float scale, SourcePosition position) {
  return mesh_field(Curvature{scale, std::move(position)});
}
Field boundary_distance_field(Field region, SourcePosition position) {
  return mesh_field(Boundary{std::move(region), std::move(position)});
}
Field mesh_distance_field(AssetPath mesh) { return mesh_field(MeshDistance{std::move(mesh)}); }

}  // namespace pelage
