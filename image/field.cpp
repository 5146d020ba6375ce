// SPDX-License-Identifier: Apache-2.0
#include "image/field.h"

#include "image/field_nodes.h"

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

std::span<const Field> Field::factors() const { return node_->factors_of(); }

std::vector<AssetPath> Field::maps() const {
  std::vector<AssetPath> maps;
  node_->collect_maps(maps);
  return maps;
}

Field Field::with_textures(TextureLibrary& textures) const {
  std::shared_ptr<const Node> loaded = node_->with_textures(textures);
  return loaded ? Field(std::move(loaded)) : *this;
}

std::string ValueReader<Field>::print(const Field& field) { return field.node().print(); }

}  // namespace pelage
