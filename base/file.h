// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/hash.h"
#include "base/open_file.h"

namespace pelage {

/// Returns the contents of a file. Throws Error (kInput) with the path when the file cannot be read, is not a
/// regular file or is longer than `limit` bytes, and with Links::kRefuse when it is a symbolic link.
std::string read_file(const std::filesystem::path& path, size_t limit = size_t(4) << 30,
                      OpenFile::Links links = OpenFile::Links::kFollow);

/// foreign_contents() tells from the first 64 bytes of a file whether the file is something else than its
/// name says: it returns "is a git-lfs pointer, not the file itself", or empty text. foreign_text(), for
/// formats that begin with ASCII characters, also knows text in UTF-16.
std::string_view foreign_contents(std::string_view beginning);
std::string_view foreign_text(std::string_view beginning);

/// Reads a text file like read_file(), without the byte-order mark of UTF-8. Also throws Error (kInput) when
/// the file is what foreign_text() knows.
std::string read_text_file(const std::filesystem::path& path, size_t limit = size_t(4) << 30);

inline constexpr std::string_view kUtf8Mark = "\xef\xbb\xbf";  ///< byte-order mark of UTF-8

/// Returns the extension of a file name in lower case, with its dot: ".exr" for "a.EXR".
std::string lower_extension(const std::filesystem::path& path);

/// Returns why a path names no regular file: "there is no such file", "is not a regular file" or, where that
/// cannot be seen, as in a cycle of links, "cannot read: " with the reason. Empty if it names one.
std::string file_problem(const std::filesystem::path& path);

/// Follows symbolic links as long as the last component of the path is one, and returns the resulting path.
/// The target need not exist. Throws Error (kFailed) for cyclic links, and for a link of another user, who
/// would decide what is overwritten; root counts as no other user.
std::filesystem::path target_of_links(const std::filesystem::path& path);

/// Returns whether two paths name the same file, also when they are spelled differently or contain symbolic
/// or hard links. The files need not exist. Links that lead nowhere, such as a cycle, name no file.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// How AtomicFile treats a symbolic link at its path.
enum class Links {
  kFollow,   ///< keeps the link; replaces its target, keeping mode and (if permitted) owner; see
             ///< target_of_links()
  kReplace,  ///< replaces the link itself (or a regular file) by a new file that this user owns
};

/// Writes a file that appears completely or not at all (law 6). The data is written to a temporary file in
/// the same folder, which commit() flushes to the disk and renames. The destructor removes the temporary file
/// if commit() was not called. sweep_temporaries() removes the temporary files of killed processes. Creates
/// missing folders of its path, but not those of the target of a symbolic link. Every member throws Error
/// (kFailed) on failure. The constructor also throws it when the path names a folder, device or pipe.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path, Links links = Links::kFollow);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Path of the temporary file, for libraries that require one.
  const std::filesystem::path& temporary_path() const { return temporary_; }
  /// Appends to the data that write() has written so far.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  /// Writes at an offset in bytes from the start of the file. Does not move the position of write().
  void write_at(uint64_t offset, std::span<const std::byte> bytes);
  /// Moves the complete file to its path.
  void commit();
  /// Moves the complete file to its path if the file there has the contents `expected`. Returns false, and
  /// keeps the file there, if another program has changed it, even while this function runs. (Where the file
  /// system cannot exchange two files, a change in the microseconds before the move is not noticed.)
  bool commit_over(std::string_view expected);

 private:
  void sync();

  std::filesystem::path named_;  ///< as given to the constructor, for messages
  std::filesystem::path path_;   ///< the file to replace
  std::filesystem::path temporary_;
  int descriptor_ = -1;
};

/// Writes a whole file through an AtomicFile. Throws Error (kFailed).
void write_file(const std::filesystem::path& path, std::string_view bytes, Links links = Links::kFollow);

/// Creates a folder, with its parents, unless it is there. For folders whose files Pelage names itself.
/// Throws Error (kFailed) when that is not possible, or when the last component of the path is a symbolic
/// link.
void make_own_folder(const std::filesystem::path& path);

/// Returns the content_hash() of all bytes of a file. Reads 256 KiB at a time, so the memory use does not
/// depend on the size of the file. Throws Error (kInput) when the file cannot be read or is not a regular
/// file.
ContentHash file_hash(const std::filesystem::path& path);

}  // namespace pelage
