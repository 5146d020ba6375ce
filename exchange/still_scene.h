// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "exchange/export_notes.h"
#include "exchange/exported_light.h"
#include "exchange/material_table.h"
#include "exchange/posed_frames.h"
#include "exchange/still_geometry.h"

namespace pelage {

/// One frame of a scene for a renderer with triangles and curves: what pbrt and Mitsuba have in common.
struct StillScene {
  struct Part {
    std::string name;                ///< "rat.under"
    std::vector<std::string> files;  ///< relative to the folder of the scene
    size_t material = 0;             ///< in `materials`
  };
  std::vector<Part> skins, coats;
  std::vector<ExportedMaterial> materials;
  std::vector<ExportedLight> lights;  ///< with the exposure of the camera
  CameraParams camera;
  Camera view;
};

/// Writes the strands of a leaf to a file.
using WriteLeaf = std::function<void(const std::filesystem::path& file, const Strands& strands)>;

/// Calls `use(scene, stem)` for every frame of the scene. The skins of the frame have been written as PLY
/// files, in the folder skins/, and its leaves by `write_leaf`, in coats/, with the extension `ending`.
/// `stem`: of the names of this frame's files, with its number if there are several frames.
void for_each_still(const std::filesystem::path& folder, const ExportSource& source,
                    const std::string& ending, const WriteLeaf& write_leaf, ExportNotes& notes,
                    const Job& job,
                    const std::function<void(const StillScene& scene, const std::string& stem)>& use);

}  // namespace pelage
