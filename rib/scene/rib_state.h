// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rib/scene/rib_batches.h"
#include "rib/scene/rib_scene.h"
#include "rib/syntax/rib_basis.h"
#include "rib/syntax/rib_parameters.h"

namespace pelage {

/// What AttributeBegin saves: the transform and the attributes [RISPEC 3.2, graphics state].
struct RibAttributes {
  RibTransform to_world;  ///< before WorldBegin: to camera space
  Rgb color{1};
  Rgb tint{1};                   ///< Attribute "pelage" "tint"
  bool chaikin_creases = false;  ///< Attribute "pelage" "chaikin"
  std::shared_ptr<const RibShader> surface;
  RibBasis basis = *RibBasis::named("bezier");
  std::string name;                       ///< Attribute "identifier" "name"
  std::shared_ptr<const RibShader> area;  ///< AreaLightSource; null for things that are not lights
};

/// The state in which a deferred archive is read.
struct RibContext {
  RibAttributes attributes;
  RibDeclarations declarations;
  std::map<std::string, RibTransform> spaces;
  std::vector<std::string> search_path;   ///< of archives
  std::vector<std::string> program_path;  ///< of procedurals
  std::filesystem::path folder;           ///< of the file that was given first
  RibShutter shutter;
  RibTransform world;                        ///< from the world of the file to the world of the scene
  std::map<std::string, uint64_t> next_ids;  ///< of strands without ids, by coat
  double time_base = 0;                      ///< subtracted from the times of the file
};

}  // namespace pelage
