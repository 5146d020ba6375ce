// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/value_readers.h"
#include "base/vector.h"

namespace pelage {

struct FieldSources;

/// A named value of a strand or of a point of a strand, which a field may read. A value with a single number
/// has this number in all three channels.
struct FieldAttribute {
  std::string_view name;
  Rgb value;
};

/// A point where a field is evaluated.
struct FieldPoint {
  V3f rest{0};         ///< position on the skin, rest space
  float u = 0, v = 0;  ///< texture coordinates of the root
  float along = 0;     ///< position along the strand: 0 at the root, 1 at the tip
  std::span<const FieldAttribute> attributes;
  V3f normal{0};      ///< unit normal of the skin at the root, rest space; 0 without a skin
  uint32_t face = 0;  ///< ptex face of the root, on a skin
  V2f face_uv{0};     ///< parameters of the root in this face
};

/// Tells which inputs a field depends on, so that callers can avoid needless evaluations.
struct FieldDependence {
  bool along = false;       ///< depends on FieldPoint::along
  bool surface = false;     ///< depends on the root: its rest position or its texture coordinates
  bool attributes = false;  ///< depends on FieldPoint::attributes
  bool rest = false;        ///< depends on FieldPoint::rest
  bool normal = false;      ///< depends on FieldPoint::normal
  bool face = false;        ///< depends on FieldPoint::face and face_uv
};

inline FieldDependence operator|(const FieldDependence& a, const FieldDependence& b) {
  return {a.along || b.along, a.surface || b.surface, a.attributes || b.attributes,
          a.rest || b.rest,   a.normal || b.normal,   a.face || b.face};
}

/// A number or colour of an operator or material that may vary over the skin and along strands: a constant, a
/// map, a ramp, noise, an attribute, a shape in rest space, something of the skin's mesh, or a function of
/// other fields. docs/MANUAL.md describes the blocks, which image/field_forms.h lists. A Field is immutable
/// and cheap to copy.
///
/// A map with the key `channel` is data: `space: auto` uses its values as stored. A map without `channel` is
/// a colour: `space: auto` decodes integer formats from sRGB and uses floating-point values as stored.
class Field {
 public:
  struct Node;

  Field(float constant = 0);
  explicit Field(Rgb constant);
  explicit Field(std::shared_ptr<const Node> node);

  /// Returns the first channel. Maps must have been loaded (with_textures()).
  float value(const FieldPoint& point) const;
  /// Returns all three channels. Maps must have been loaded (with_textures()).
  Rgb color(const FieldPoint& point) const;

  FieldDependence dependence() const;
  bool is_constant() const;
  /// Returns the min and max that the first channel can have. For a map, these are the bounds of its texels,
  /// or of its `range` until the map has been loaded. For the attributes `random` and `clump`, they are 0 and
  /// 1. Other attributes have no bounds except the limits of the key that the field is read for.
  std::pair<float, float> value_range() const;
  /// Returns the names of the attributes that the field reads, without repetitions.
  std::vector<std::string> attribute_names() const;

  /// Returns the fields from which this one is computed. Empty for fields that are not computed from others.
  std::span<const Field> inputs() const;
  /// Returns the files of all maps, each with the position in the scene that names the file. The name of a
  /// map with UDIM tiles has a placeholder. `by_texture`: only maps that are looked up by texture
  /// coordinates.
  std::vector<AssetPath> maps(bool by_texture = false) const;
  /// Returns all files whose contents are part of the field.
  std::vector<std::filesystem::path> files() const;

  /// Returns this field after loading its maps and the values that it reads from the skin. Throws the errors
  /// of TextureLibrary::load(), and Error (kInput) when an image has no channel of the given name, and when
  /// the field needs a skin, or something of the skin, that does not exist. These errors have the position in
  /// the scene.
  Field with_textures(const FieldSources& sources) const;

  const Node& node() const { return *node_; }
  const std::shared_ptr<const Node>& shared_node() const { return node_; }

 private:
  std::shared_ptr<const Node> node_;
};

/// Reads a field. The limits of the key (KeyOptions::min and max) apply to every value of the field. A
/// constant outside the limits is a problem. The values of maps, noise, attributes and products are clamped
/// to the limits.
template <>
struct ValueReader<Field> {
  static bool read(const Value&, const KeyOptions&, Field& out, Problems&);
  static std::string type_name() { return "field"; }
  static std::string print(const Field& field);
  static void add_files(const Field& field, std::vector<std::filesystem::path>& files) {
    for (std::filesystem::path& file : field.files()) files.push_back(std::move(file));
  }
  static void add_maps(const Field& field, std::vector<ParameterText::Map>& maps) {
    for (const AssetPath& map : field.maps(true)) maps.push_back({map.path, map.position});
  }
  static std::vector<const SchemaInfo*> blocks();
  static void visit_blocks(Value& value, const BlockVisitor& visit);
};

/// Returns smooth gradient noise in [-1, 1] [Perlin02, "Improving noise"]. The noise is 0 where all
/// coordinates are integers. The result is the same on every machine.
float perlin_noise(const V3f& p, uint32_t seed = 0);
/// Returns three uncorrelated values of such noise.
V3f perlin_noise3(const V3f& p, uint32_t seed = 0);

}  // namespace pelage
