// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace pelage {

/// Tells versions of a file apart without reading the file. All members are 0 for a file that does not exist.
struct FileStamp {
  uint64_t inode = 0;
  int64_t size = 0;
  int64_t changed_ns = 0;  ///< time of the last modification
  bool operator==(const FileStamp&) const = default;
};

/// Returns the stamp of a file as it is now. Follows symbolic links.
FileStamp file_stamp(const std::filesystem::path& file);

}  // namespace pelage
