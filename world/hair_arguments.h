// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/document.h"

namespace pelage {

/// Consecutive leaves of a coat: first <= leaf < end.
struct LeafRange {
  size_t first = 0, end = 0;
  size_t count() const { return end - first; }
};

/// The arguments of a procedural in a RIB file: "rat.yaml character=rat coat=under frame=3". They are divided
/// at blanks. Single quotes keep blanks together: 'my scene.yaml' 'set=materials.fur={model: deon}'. Between
/// single quotes, '' is one single quote.
struct HairArguments {
  std::string scene;
  std::vector<Override> overrides;  ///< set=key=value, and memory=512M as an override of render.memory
  std::optional<int> frame;         ///< frame=3; empty: the first frame of the scene
  std::string character;            ///< empty: all characters
  std::string coat;                 ///< name of a groom; empty: all coats of the character
  std::optional<LeafRange> leaves;  ///< leaf=4 or leaf=4-7, which has both ends; empty: all
  /// camera=scene: the camera of `render.lod` and the keys of `render.lod` determine the level of detail.
  bool scene_camera = false;
  /// scale=20: level of detail as if all strands had this size in the picture, in pixels per scene unit.
  std::optional<float> pixels_per_unit;
  bool full_detail = false;  ///< detail=full: all strands
  int threads = 0;           ///< threads=2: for reading the scene and measuring boxes; 0: all available
};

/// Parses arguments. Throws Error (kArguments) with one line, with the nearest known name for unknown names.
HairArguments parse_hair_arguments(std::string_view text);

/// Returns a text that parse_hair_arguments() converts to the same arguments.
std::string print_hair_arguments(const HairArguments& arguments);

}  // namespace pelage
