// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "exchange/export_notes.h"
#include "exchange/scene_export.h"

namespace pelage {

/// Writes the frames of a scene as one USD stage in text: NAME.usda, which a program opens without reading a
/// strand; skins/, one layer per skin of a character; and coats/, one layer per coat with payloads for its
/// leaves. Coats and skins that move have time samples at the motion keys of each frame. Returns the path of
/// the stage.
std::vector<std::filesystem::path> write_usd_scene(const std::filesystem::path& folder,
                                                   const ExportSource& source, ExportNotes& notes,
                                                   const Job& job);

}  // namespace pelage
