// SPDX-License-Identifier: Apache-2.0
#include "image/field.h"

#include "image/field_nodes.h"
#include "image/udim.h"

namespace pelage {
namespace {

struct Constant final : Field::Node {
  explicit Constant(Rgb c) : rgb(c) {}
  float value(const FieldPoint&) const override { return rgb.x; }
  Rgb color(const FieldPoint&) const override { return rgb; }
  FieldDependence dependence() const override { return {}; }
  std::pair<float, float> range() const override { return {rgb.x, rgb.x}; }
  std::string print() const override {
    const bool grey = rgb.x == rgb.y && rgb.y == rgb.z;
    return grey ? ValueReader<float>::print(rgb.x) : ValueReader<Rgb>::print(rgb);
  }

  Rgb rgb;
};

}  // namespace

Field::Field(float constant) : Field(Rgb(constant)) {}
Field::Field(Rgb constant) : node_(std::make_shared<Constant>(constant)) {}
Field::Field(std::shared_ptr<const Node> node) : node_(std::move(node)) {}

float Field::value(const FieldPoint& point) const { return node_->value(point); }
Rgb Field::color(const FieldPoint& point) const { return node_->color(point); }
FieldDependence Field::dependence() const { return node_->dependence(); }
std::pair<float, float> Field::value_range() const { return node_->range(); }

bool Field::is_constant() const {
  const FieldDependence d = dependence();
  return !d.along && !d.surface && !d.attributes;
}

std::vector<std::string> Field::attribute_names() const {
  std::vector<std::string> names;
  node_->collect_attributes(names);
  return names;
}

std::span<const Field> Field::inputs() const { return node_->inputs(); }

std::vector<AssetPath> Field::maps(bool by_texture) const {
  std::vector<AssetPath> maps;
  node_->collect_maps(maps, by_texture);
  return maps;
}

std::vector<std::filesystem::path> Field::files() const {
  std::vector<std::filesystem::path> files;
  for (const AssetPath& map : maps()) {
    if (map.data) continue;
    const std::vector<std::filesystem::path> tiles = map_files(map.path);
    files.insert(files.end(), tiles.begin(), tiles.end());
  }
  node_->collect_files(files);
  return files;
}

Field Field::with_textures(const FieldSources& sources) const {
  std::shared_ptr<const Node> loaded = node_->with_textures(sources);
  return loaded ? Field(std::move(loaded)) : *this;
}

std::string ValueReader<Field>::print(const Field& field) { return field.node().print(); }

}  // namespace pelage
