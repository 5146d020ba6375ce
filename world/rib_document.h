// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "base/error.h"
#include "base/value.h"

namespace pelage {

/// Returns whether a file is RIB, by its name: .rib or .rib.gz.
bool is_rib(const std::filesystem::path& path);

/// Reads a RIB file with a camera as a scene: the camera, image, lights, materials, the blocks that Option
/// "pelage" contains, and the file itself as an archive. Warnings are appended to `warnings`. Throws Error
/// (kInput).
Value rib_document(const std::filesystem::path& path, std::vector<Problem>& warnings);

/// For each archive of a document, adds the materials of those surfaces that the archive's table `materials`
/// does not mention, as "ARCHIVE.SURFACE", and adds them to the table. Warnings of the files are appended to
/// `warnings`. Throws Error (kInput).
void add_archive_materials(Value& document, std::vector<Problem>& warnings);

}  // namespace pelage
