// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "base/error.h"
#include "base/value.h"
#include "rib/document/rib_use.h"

namespace pelage {

/// Returns whether a file is RIB, by its name: .rib or .rib.gz.
bool is_rib(const std::filesystem::path& path);

/// Reads a RIB file with a camera as a scene: the camera, image, lights, materials, the blocks that Option
/// "pelage" contains, and the file itself as an archive. `max_request_bytes`: memory of the arguments of one
/// request. Warnings are appended to `warnings`. Throws Error (kInput).
Value rib_document(const std::filesystem::path& path, const RibUse& use, size_t max_request_bytes,
                   std::vector<Problem>& warnings);

/// For each archive of a document, adds the materials of those surfaces that the archive's table `materials`
/// does not mention, as "ARCHIVE.SURFACE", and adds them to the table. Warnings of the files are appended to
/// `warnings`. Throws Error (kInput).
void add_archive_materials(Value& document, const RibUse& use, size_t max_request_bytes,
                           std::vector<Problem>& warnings);

}  // namespace pelage
