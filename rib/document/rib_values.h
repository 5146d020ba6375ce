// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/value.h"
#include "base/vector.h"
#include "rib/document/rib_material_table.h"
#include "rib/scene/rib_scene.h"

namespace pelage {

// Values of a scene document that come from a RIB file.

Value rib_text(const SourcePosition& position, std::string text);
Value rib_number(const SourcePosition& position, double number);
Value rib_vector(const SourcePosition& position, const V3f& v);
void add_entry(Value& map, std::string key, Value value);

/// Parses the YAML text of a setting that Pelage wrote: a block. All positions in it are that of the setting.
/// Throws Error (kInput).
Value rib_block(const RibSetting& setting);

/// Returns the value of a setting: a text, a number or a list of numbers; nullopt for several texts.
std::optional<Value> rib_setting(const RibSetting& setting);

/// Returns the colour of a material that has no shader: the colours of its strands if they have any,
/// otherwise the colour of the request Color.
Value rib_color(const RibMaterial& material, const SourcePosition& position);
/// Adds the opacity of a material of strands to its block, if it is not 1.
void add_opacity(Value& block, const RibMaterial& material, const SourcePosition& position);
/// Returns the block of a material whose shader is a Bxdf of RenderMan that Pelage knows.
std::optional<Value> rib_bxdf(const RibMaterial& material);

/// Makes materials of the surfaces of all RIB files of a scene.
class RibMaterials {
 public:
  explicit RibMaterials(RibMaterialTable table) : table_(std::move(table)) {}
  /// Returns the block of a material: that of the table, of Pelage, of the shader's parameter "model", or the
  /// default. Appends a warning if the shader is not known: one per name of a shader.
  Value material(const RibMaterial& material, std::vector<Problem>& warnings);
  /// Notes the names of a material whose block comes from elsewhere.
  void note(const RibMaterial& material);
  /// Appends a warning for each entry of the table that was not used.
  void finish(std::vector<Problem>& warnings) const { table_.warn_of_unused(names_, warnings); }

 private:
  const RibMaterialTable table_;
  std::set<std::string> names_, unknown_;  // of shaders and materials; of unknown shaders
};

/// Makes blocks of the lights of a RIB file.
class RibLights {
 public:
  /// Returns the block of a light; empty, with one warning per name of a shader, if it is not supported.
  std::optional<Value> light(const RibLight& light, std::vector<Problem>& warnings);

 private:
  std::set<std::string> warned_;
};

}  // namespace pelage
