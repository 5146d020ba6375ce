// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "exchange/export_notes.h"
#include "exchange/scene_export.h"

namespace pelage {

/// Writes the frames of a scene for Mitsuba 3: one XML file per frame, PLY files for skins, and one file of
/// B-spline curves per leaf. Returns the paths of the frames.
std::vector<std::filesystem::path> write_mitsuba_scene(const std::filesystem::path& folder,
                                                       const ExportSource& source, ExportNotes& notes,
                                                       const Job& job);

}  // namespace pelage
