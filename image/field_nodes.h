// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/value_readers.h"
#include "image/field.h"
#include "image/texture_library.h"

// The kinds of fields (see image/field.h), and the blocks of a scene that describe fields.

namespace pelage {

struct Field::Node {
  virtual ~Node() = default;
  virtual float value(const FieldPoint& point) const = 0;
  virtual Rgb color(const FieldPoint& point) const = 0;
  virtual FieldDependence dependence() const = 0;
  virtual std::pair<float, float> range() const = 0;
  virtual std::string print() const = 0;
  virtual void collect_attributes(std::vector<std::string>&) const {}
  virtual std::span<const Field> factors_of() const { return {}; }
  virtual void collect_maps(std::vector<AssetPath>&) const {}
  /// Returns a copy of the node with its maps loaded, or nullptr when the node contains no maps.
  virtual std::shared_ptr<const Node> with_textures(TextureLibrary&) const { return nullptr; }
  /// Returns the position where the scene names the attribute `name` in this field; nullptr when the field
  /// does not read this attribute.
  virtual const SourcePosition* place_of_attribute(std::string_view name) const {
    for (const Field& factor : factors_of()) {
      if (const SourcePosition* place = factor.node().place_of_attribute(name)) return place;
    }
    return nullptr;
  }
};

enum class MapChannel { kR, kG, kB, kA };
template <>
struct EnumNames<MapChannel> {
  static constexpr const char* names[] = {"r", "g", "b", "a"};
};

template <>
struct EnumNames<TextureWrap> {
  static constexpr const char* names[] = {"clamp", "repeat"};
};

/// Keys of {map: f.png, channel: r, range: [a, b], space: auto, wrap: clamp}. Stored values 0 and 1 become a
/// and b.
struct MapForm {
  AssetPath map;
  std::optional<MapChannel> channel;
  V2f range{0, 1};
  ColorSpace space = ColorSpace::kAuto;
  TextureWrap wrap = TextureWrap::kClamp;
  static const Schema<MapForm>& schema();
};

enum class RampAxis { kStrand, kX, kY, kZ, kU, kV };
template <>
struct EnumNames<RampAxis> {
  static constexpr const char* names[] = {"strand", "x", "y", "z", "u", "v"};
};

struct RampKnot {
  float at = 0;
  Rgb value{0};
};
template <>
struct ValueReader<RampKnot> {
  static bool read(const Value&, const KeyOptions&, RampKnot& out, Problems&);
  static std::string type_name() { return "[number, number or colour]"; }
  static std::string print(const RampKnot& knot);
};

struct Ramp {
  RampAxis along = RampAxis::kStrand;
  std::vector<RampKnot> knots;  ///< by increasing `at`; two knots with the same `at` make a step
  static const Schema<Ramp>& schema();
};

struct Noise {
  float frequency = 1;
  float amplitude = 1;
  float offset = 0;
  int seed = 0;
  static const Schema<Noise>& schema();
};

Field map_field(MapForm form);
Field ramp_field(Ramp ramp);
Field noise_field(Noise noise);
Field attribute_field(std::string name, SourcePosition named_at = {});
Field product_field(std::vector<Field> factors);
/// Returns a field with the values of `field`, each channel clamped to [low, high].
Field clamped_field(Field field, float low, float high);

}  // namespace pelage
