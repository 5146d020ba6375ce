// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "image/field.h"
#include "image/field_skin.h"

namespace pelage {

/// What every kind of field implements.
struct Field::Node {
  virtual ~Node() = default;
  virtual float value(const FieldPoint& point) const = 0;
  virtual Rgb color(const FieldPoint& point) const = 0;
  virtual FieldDependence dependence() const = 0;
  virtual std::pair<float, float> range() const = 0;
  virtual std::string print() const = 0;
  /// Fields from which this one is computed. If there are any, a value depends on nothing but their values.
  virtual std::span<const Field> inputs() const { return {}; }
  /// Computes `count` values of one channel. `rows`: for each input, its values of this channel.
  virtual void combine(std::span<const float* const> /*rows*/, int /*channel*/, size_t /*count*/,
                       float* /*out*/) const {}
  virtual void collect_attributes(std::vector<std::string>& names) const {
    for (const Field& input : inputs()) input.node().collect_attributes(names);
  }
  /// `by_texture`: only the maps that are looked up by texture coordinates.
  virtual void collect_maps(std::vector<AssetPath>& maps, bool by_texture) const {
    for (const Field& input : inputs()) input.node().collect_maps(maps, by_texture);
  }
  /// Adds the files, other than maps, whose contents are part of the field.
  virtual void collect_files(std::vector<std::filesystem::path>& files) const {
    for (const Field& input : inputs()) input.node().collect_files(files);
  }
  /// Returns the node with everything that it reads from `sources`; nullptr when it reads nothing.
  virtual std::shared_ptr<const Node> with_textures(const FieldSources&) const { return nullptr; }
  /// Returns the position where the scene names the attribute `name` in this field; nullptr when the field
  /// does not read this attribute.
  virtual const SourcePosition* place_of_attribute(std::string_view name) const {
    for (const Field& input : inputs()) {
      if (const SourcePosition* place = input.node().place_of_attribute(name)) return place;
    }
    return nullptr;
  }
};

}  // namespace pelage
