// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace pelage {

/// Prefix of the names of temporary files.
inline constexpr std::string_view kTemporaryPrefix = ".pelage-";

/// A new, empty file in the folder of its target, so that renaming stays on one file system:
/// ".pelage-HOST-PROCESS-RANDOM.ENDING". The ending is that of the target, for libraries that depend on it.
struct TemporaryFile {
  std::filesystem::path path;
  int descriptor = -1;  ///< open for reading and writing, and locked (flock); -1: failed, see errno
};

/// The caller must close the descriptor, which releases the lock, and rename or remove the file.
TemporaryFile create_temporary(const std::filesystem::path& target);

/// Removes from `folder` the temporary files of killed processes: those of create_temporary() that were made
/// on this machine by this user, whose process no longer exists and whose lock is free. Leaves files alone in
/// case of doubt or failure. Safe while other processes write there.
void sweep_temporaries(const std::filesystem::path& folder);

}  // namespace pelage
