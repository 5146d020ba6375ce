// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace pelage {

/// Whole contents of a file. Throws Error (kInput) with the path when it cannot be read, is not a regular
/// file or is longer than `limit` bytes.
std::string read_file(const std::filesystem::path& path, size_t limit = size_t(4) << 30);

/// A file that appears whole or not at all (law 6): written under a temporary name beside `path`, synced and
/// renamed by commit(). Without commit() the temporary is removed. Creates missing folders, follows links,
/// and refuses to stand in for a device or pipe. Throws Error
/// (kFailed).
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write before commit(), for libraries that want a path.
  const std::filesystem::path& temporary_path() const { return temporary_; }
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
};

}  // namespace pelage
