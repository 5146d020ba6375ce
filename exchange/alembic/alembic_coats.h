// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "exchange/export_notes.h"
#include "exchange/scene_export.h"

namespace pelage {

/// Writes the coats of a scene as Alembic files, one file per frame: NAME.abc, or NAME.0001.abc and so on if
/// there are several frames. Each character is a transform (alembic_groom()), each coat of it a Curves object
/// (add_alembic_curves()) in world space, in the middle of the shutter. Returns the files. Throws Error
/// (kMemory) when the strands of a coat do not fit the memory limit.
std::vector<std::filesystem::path> write_alembic_coats(const std::filesystem::path& folder,
                                                       const ExportSource& source, ExportNotes& notes,
                                                       const Job& job);

}  // namespace pelage
