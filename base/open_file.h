// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>

#include <sys/types.h>

namespace pelage {

/// A regular file that is open for reading, with its attributes. They belong to the open file, even if its
/// path refers to another file later.
class OpenFile {
 public:
  enum class Links { kFollow, kRefuse };
  /// Throws Error (kInput) when `path` cannot be read, is not a regular file, or is a symbolic link and
  /// `links` refuses those.
  explicit OpenFile(std::filesystem::path path, Links links = Links::kFollow);
  ~OpenFile();
  OpenFile(OpenFile&& other) noexcept;
  OpenFile& operator=(OpenFile&& other) noexcept;

  const std::filesystem::path& path() const { return path_; }
  int descriptor() const { return descriptor_; }
  size_t bytes() const { return bytes_; }
  uid_t owner() const { return owner_; }

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  size_t bytes_ = 0;
  uid_t owner_ = 0;
};

}  // namespace pelage
