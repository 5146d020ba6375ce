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

/// Contents of a file. Throws Error (kInput) with the path when it cannot be read, is not a regular file or
/// is longer than `limit` bytes.
std::string read_file(const std::filesystem::path& path, size_t limit = size_t(4) << 30);

/// Target of a path after following symbolic links at its end; it need not exist. Throws Error (kFailed) for
/// cyclic links.
std::filesystem::path target_of_links(std::filesystem::path path);

/// Whether two paths refer to the same file, even by different spellings, symbolic links or hard links. The
/// files need not exist.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// How AtomicFile treats a symbolic link at its path.
enum class Links {
  kFollow,   ///< replaces the target of the link, keeping its mode and owner; the link stays
  kReplace,  ///< replaces the link itself, or any file, by a new file that this user owns
};

/// A file that appears completely or not at all (law 6): written under a temporary name in the same folder,
/// synced, and renamed by commit(). Without commit(), the temporary file is removed. sweep_temporaries()
/// removes the temporary files of killed processes. Creates missing folders and refuses to replace a device
/// or pipe. Throws Error (kFailed).
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path, Links links = Links::kFollow);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Path of the temporary file, for libraries that require one.
  const std::filesystem::path& temporary_path() const { return temporary_; }
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  /// Writes at an offset, independent of write().
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
