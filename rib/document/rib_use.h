// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

namespace pelage {

class RibPrograms;

/// What the user states about the RIB files of a scene. Not part of the scene, because a scene of a stranger
/// must not run programs by itself.
struct RibUse {
  std::filesystem::path materials;        ///< table of materials (RibMaterialTable); empty: none
  std::shared_ptr<RibPrograms> programs;  ///< runs programs of procedurals; null: they are skipped
  bool overrides = false;  ///< whether the overrides of the scene come from a RIB file, not from the user
};

}  // namespace pelage
