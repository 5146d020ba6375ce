// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "base/mapped_file.h"
#include "geom/alembic/ogawa_layout.h"

namespace pelage {

/// A group of an Ogawa file: its position in bytes, and how many children it has. The empty group is at 0.
struct OgawaGroup {
  uint64_t position = 0, count = 0;
};

/// Ogawa, the container of Alembic: a tree of groups and blocks of data. A group is a 64-bit count and as
/// many 64-bit words: positions of groups, or of blocks if the top bit is set. A block is its 64-bit size and
/// its bytes. All numbers are little-endian. Every size is checked against the length of the file before use.
class OgawaFile {
 public:
  /// Maps the file into memory. Throws Error (kInput) if the file cannot be read, is of another kind, such as
  /// the older HDF5 kind of Alembic, or was not closed by the program that wrote it.
  explicit OgawaFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  uint64_t size() const { return bytes_.size(); }
  OgawaGroup root() const;
  /// Whether a child of a group is a group, or data.
  bool is_group(const OgawaGroup& group, uint64_t child) const { return !(word(group, child) & kOgawaData); }
  /// Return a child. Throw Error (kInput) if there is none, if it is not of this kind, or if it does not fit
  /// the file.
  OgawaGroup group(const OgawaGroup& parent, uint64_t child) const;
  std::span<const std::byte> data(const OgawaGroup& parent, uint64_t child) const;

  /// Throws Error (kInput) with the file, `what` and a position in bytes.
  [[noreturn]] void fail(const std::string& what, uint64_t position) const;
  [[noreturn]] void fail(const std::string& what, std::span<const std::byte> at) const {
    fail(what, at.empty() ? 0 : static_cast<uint64_t>(at.data() - bytes_.data()));
  }

 private:
  uint64_t word(const OgawaGroup& group, uint64_t child) const;
  uint64_t number_at(uint64_t position) const;
  OgawaGroup group_at(uint64_t position) const;

  const std::filesystem::path path_;
  MappedFile file_;
  std::span<const std::byte> bytes_;
};

}  // namespace pelage
