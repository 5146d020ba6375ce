// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace pelage {

/// How the names of temporary files begin.
inline constexpr std::string_view kTemporaryPrefix = ".pelage-";

/// A new, empty file beside the one that it will replace, so that the rename stays on one file system:
/// ".pelage-HOST-PROCESS-RANDOM.ENDING". The ending is that of the target, for libraries that look at it.
struct TemporaryFile {
  std::filesystem::path path;
  int descriptor = -1;  ///< open for reading and writing and locked (flock); -1: errno says why there is none
};

/// The caller closes the descriptor, which ends the lock, and renames or removes the file.
TemporaryFile create_temporary(const std::filesystem::path& target);

/// Removes from `folder` the temporary files of processes that were killed: those of create_temporary() that
/// were made on this machine, by this user, whose process is gone and whose lock nobody holds. Whatever
/// cannot be decided is left alone, and so is everything on failure. Safe beside processes that write there.
void sweep_temporaries(const std::filesystem::path& folder);

}  // namespace pelage
