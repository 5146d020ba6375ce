// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace pelage {

/// Prefix of the names of temporary files.
inline constexpr std::string_view kTemporaryPrefix = ".pelage-";

/// A new, empty file in the folder of its target, so that renaming stays on one file system:
/// ".pelage-HOST-PROCESS-RANDOM.ENDING". It ends like the target, because libraries depend on the ending.
struct TemporaryFile {
  std::filesystem::path path;
  int descriptor = -1;  ///< open for reading and writing, and locked (flock); -1: failed, see errno
};

/// The caller must close the descriptor, which releases the lock, and rename or remove the file.
TemporaryFile create_temporary(const std::filesystem::path& target);

/// Removes the temporary files that killed processes left in `folder`. A file is removed if this user made it
/// on this machine with create_temporary(), its process no longer exists and its lock is free. In case of
/// doubt or failure the file stays. Safe while other processes write there.
void sweep_temporaries(const std::filesystem::path& folder);

}  // namespace pelage
