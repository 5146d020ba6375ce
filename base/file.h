// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pelage {

/// Whole contents of a file. Throws Error (kInput) with the path when it cannot be read, is not a regular
/// file or is longer than `limit` bytes.
std::string read_file(const std::filesystem::path& path, size_t limit = size_t(4) << 30);

/// Where a path leads once symbolic links at its end are followed, also to a file that does not exist yet.
/// Throws Error (kFailed) for links that lead in a circle.
std::filesystem::path target_of_links(std::filesystem::path path);

/// Whether two paths name one file, by any spelling, symbolic or hard link; the files need not exist.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// What AtomicFile does with a symbolic link at its path.
enum class Links {
  kFollow,   ///< replaces the file that the link leads to, keeping its mode and owner; the link stays
  kReplace,  ///< replaces the link itself, and any file, by one of this user
};

/// A file that appears whole or not at all (law 6): written under a temporary name beside its place, synced
/// and renamed by commit(). Without commit() the temporary is removed; one that a killed process left is
/// found by sweep_temporaries(). Creates missing folders and refuses to replace a device or pipe. Throws
/// Error (kFailed).
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path, Links links = Links::kFollow);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write before commit(), for libraries that want a path.
  const std::filesystem::path& temporary_path() const { return temporary_; }
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  /// Writes at a place of its own, whatever write() has written.
  void write_at(uint64_t offset, std::span<const std::byte> bytes);
  void commit();

 private:
  std::filesystem::path named_;  ///< as given, for messages
  std::filesystem::path path_;   ///< the file to replace
  std::filesystem::path temporary_;
  int descriptor_ = -1;
};

/// Writes a whole file as AtomicFile does. Throws Error (kFailed).
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace pelage
