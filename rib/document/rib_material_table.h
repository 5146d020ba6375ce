// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/value.h"
#include "rib/scene/rib_scene.h"

namespace pelage {

/// A user's table of materials for the shaders of RIB files. A YAML file:
///
///   plastic: {model: glossy, color: $Color, roughness: $roughness}
///   fox_hair: {model: deon, color: $rootcolor, primary_width: $width}
///   matte: {meshes: {model: lambert, color: $Color}, curves: {model: cone-shell, color: $Color}}
///
/// A key is the name of a shader, or of the material (its parameter "name"). $NAME stands for the value of
/// this parameter of the shader. If the shader lacks it, the key of the material is left out, so its default
/// holds. $Color stands for the colours of the strands if they have any, and otherwise for the request Color.
class RibMaterialTable {
 public:
  /// An empty table.
  RibMaterialTable() = default;
  /// Throws Error (kInput) for a file that cannot be read or is not a table.
  explicit RibMaterialTable(const std::filesystem::path& path);

  /// Returns the material of a surface; nullopt if the table has none.
  std::optional<Value> find(const RibMaterial& material) const;
  /// Adds a warning for each entry that `used` does not contain, with the nearest name among `used`.
  /// `used`: the names of shaders and materials of all files.
  void warn_of_unused(const std::set<std::string>& used, std::vector<Problem>& warnings) const;

 private:
  Value table_;
};

}  // namespace pelage
