// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/value_readers.h"
#include "base/vector.h"

namespace pelage {

class TextureLibrary;

/// A named per-strand or per-point value that a field may read; a single number is repeated for three
/// channels.
struct FieldAttribute {
  std::string_view name;
  Rgb value;
};

/// Where a field is evaluated.
struct FieldPoint {
  V3f rest{0};         ///< position on the skin, rest space
  float u = 0, v = 0;  ///< texture coordinates of the root
  float along = 0;     ///< 0 at the root, 1 at the tip
  std::span<const FieldAttribute> attributes;
};

/// Which inputs a field depends on, so that callers evaluate it no more often than needed.
struct FieldDependence {
  bool along = false;       ///< changes along a strand
  bool surface = false;     ///< changes over the skin
  bool attributes = false;  ///< reads attributes
  bool rest = false;        ///< changes with the position in rest space, not with (u, v) alone
};

/// A number or colour of an operator or material that may vary: a constant, a map, a ramp, noise, an
/// attribute, or a product of fields. docs/MANUAL.md has the keys. An immutable value, cheap to copy.
///
///   0.5 | [r, g, b]
///   {map: f.png, channel: r, range: [a, b], space: auto|linear|srgb}    # without channel: colour
///   {ramp: {along: strand|x|y|z|u|v, knots: [[0, value], [1, value]]}}  # linear; values may be colours
///   {noise: {frequency, amplitude, offset, seed}}    # offset + amplitude * noise(rest * frequency)
///   {attribute: name}                                # 0 where strands do not have it
///   {product: [field, field, ...]}
///
/// A map with a channel is data: `space: auto` uses it as stored. A map without one is a colour: auto decodes
/// integer formats from sRGB and leaves floating-point formats unchanged.
class Field {
 public:
  struct Node;

  Field(float constant = 0);
  explicit Field(Rgb constant);
  explicit Field(std::shared_ptr<const Node> node);

  /// First channel / all three. Maps must have been loaded (with_textures).
  float value(const FieldPoint& point) const;
  Rgb color(const FieldPoint& point) const;

  FieldDependence dependence() const;
  bool is_constant() const;
  /// Bounds of the values of the first channel. Maps: bounds of their contents, or of their `range` until
  /// they are loaded. Attributes are unbounded except for the limits of the key; `random` and `clump` are in
  /// [0, 1] wherever they are set.
  std::pair<float, float> value_range() const;
  /// Names of the attributes it reads.
  std::vector<std::string> attribute_names() const;

  /// The factors of a product, in order; empty for other fields.
  std::span<const Field> factors() const;
  /// The maps that are looked up by texture coordinates, each with its position in the scene.
  std::vector<AssetPath> maps() const;

  /// The same field with its maps loaded. Throws Error (kInput) at the position in the scene that names the
  /// map.
  Field with_textures(TextureLibrary& textures) const;

  const Node& node() const { return *node_; }

 private:
  std::shared_ptr<const Node> node_;
};

/// The limits of the options hold for every value of a field: constants outside them are refused; the results
/// of maps, noise, attributes and products are clamped to them.
template <>
struct ValueReader<Field> {
  static bool read(const Value&, const KeyOptions&, Field& out, Problems&);
  static std::string type_name() { return "field"; }
  static std::string print(const Field& field);
  static void add_files(const Field& field, std::vector<std::filesystem::path>& files) {
    for (const AssetPath& map : field.maps()) files.push_back(map.path);
  }
  static void add_maps(const Field& field, std::vector<ParameterText::Map>& maps) {
    for (const AssetPath& map : field.maps()) maps.push_back({map.path, map.position});
  }
  static std::vector<const SchemaInfo*> blocks();
  static void visit_blocks(Value& value, const BlockVisitor& visit);
};

/// Smooth gradient noise in [-1, 1], zero at lattice points, the same on every machine. `perlin_noise3` gives
/// three decorrelated values. [Perlin02, "Improving noise"]
float perlin_noise(const V3f& p, uint32_t seed = 0);
V3f perlin_noise3(const V3f& p, uint32_t seed = 0);

}  // namespace pelage
