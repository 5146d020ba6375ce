// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>

#include <sys/types.h>

namespace pelage {

/// A regular file that is open for reading, with its size and owner. Both describe the open file, even if
/// another file has this path later.
class OpenFile {
 public:
  enum class Links { kFollow, kRefuse };
  /// Throws Error (kInput) when `path` cannot be read or is not a regular file. With Links::kRefuse, also
  /// throws when the last component of `path` is a symbolic link.
  explicit OpenFile(std::filesystem::path path, Links links = Links::kFollow);
  ~OpenFile();
  OpenFile(OpenFile&& other) noexcept;
  OpenFile& operator=(OpenFile&& other) noexcept;

  const std::filesystem::path& path() const { return path_; }
  int descriptor() const { return descriptor_; }
  /// Size when the file was opened, in bytes.
  size_t bytes() const { return bytes_; }
  uid_t owner() const { return owner_; }

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  size_t bytes_ = 0;
  uid_t owner_ = 0;
};

}  // namespace pelage
