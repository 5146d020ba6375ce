// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace pelage {

/// Prefix of the names of temporary files.
inline constexpr std::string_view kTemporaryPrefix = ".pelage-";

/// A new, empty file that will be renamed to a target path. The file is in the folder of the target, so that
/// renaming stays on one file system. Its name is ".pelage-HOST-PROCESS-RANDOM.ENDING", with the file name
/// extension of the target, because libraries choose the format by the extension.
struct TemporaryFile {
  std::filesystem::path path;
  int descriptor = -1;  ///< open for reading and writing, and locked (flock); -1 on failure, see errno
};

/// Creates a temporary file for `target`. The caller must rename or remove the file, and close the
/// descriptor, which releases the lock.
TemporaryFile create_temporary(const std::filesystem::path& target);

/// Returns a name that distinguishes this machine from others with access to the same folder. It contains no
/// '-' and no blank.
std::string machine_name();

/// Removes the temporary files that killed processes left in `folder`. A file is removed only if this user
/// made it on this machine with create_temporary(), the process that made it no longer exists, and nobody
/// holds its lock. In case of doubt or failure, the file stays. Safe while other processes write to the
/// folder.
void sweep_temporaries(const std::filesystem::path& folder);

}  // namespace pelage
