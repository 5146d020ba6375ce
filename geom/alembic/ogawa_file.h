// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/open_file.h"
#include "geom/alembic/ogawa_layout.h"

namespace pelage {

/// A group of an Ogawa file: its position in bytes, and how many children it has. The empty group is at 0.
struct OgawaGroup {
  uint64_t position = 0, count = 0;
};
/// A block of data: the position of its first byte, and its size.
struct OgawaBlock {
  uint64_t position = 0, size = 0;

  /// Returns the part of the block that begins at byte `offset`.
  OgawaBlock from(uint64_t offset) const { return {position + offset, size - offset}; }
  OgawaBlock first(uint64_t bytes) const { return {position, bytes}; }
};

/// Ogawa, the container of Alembic: a tree of groups and blocks of data. A group is a 64-bit count and as
/// many 64-bit words: positions of groups, or of blocks if the top bit is set. A block is its 64-bit size and
/// its bytes. All numbers are little-endian. Every size is checked against the length of the file before use.
///
/// The file is read part by part and never mapped into memory, because programs may write it while it is
/// open: if it is shorter than it was, reading throws Error (kInput). For use by one thread.
class OgawaFile {
 public:
  /// Throws Error (kInput) if the file cannot be read, is of another kind, such as the older HDF5 kind of
  /// Alembic, or was not closed by the program that wrote it.
  explicit OgawaFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return file_.path(); }
  uint64_t size() const { return file_.bytes(); }
  OgawaGroup root() const;
  /// Whether a child of a group is a group, or data.
  bool is_group(const OgawaGroup& group, uint64_t child) const { return !(word(group, child) & kOgawaData); }
  /// Return a child; block() does not read its data. Throw Error (kInput) if there is no such child, if it is
  /// not of this kind, or if it does not fit the file.
  OgawaGroup group(const OgawaGroup& parent, uint64_t child) const;
  OgawaBlock block(const OgawaGroup& parent, uint64_t child) const;

  /// Reads the first bytes of a block.
  void read(const OgawaBlock& block, std::span<std::byte> to) const;
  /// Reads a block and keeps its bytes as long as this object. All kept blocks together have no more bytes
  /// than the file, or else the file has overlapping blocks: throws Error (kInput).
  std::span<const std::byte> keep(const OgawaBlock& block) const;

  /// Throws Error (kInput) with the file, `what` and a position in bytes.
  [[noreturn]] void fail(const std::string& what, uint64_t position) const;
  [[noreturn]] void fail(const std::string& what, const OgawaBlock& at) const { fail(what, at.position); }

 private:
  uint64_t word(const OgawaGroup& group, uint64_t child) const;
  uint64_t number_at(uint64_t position) const;
  OgawaGroup group_at(uint64_t position) const;
  void read_at(uint64_t position, std::span<std::byte> to) const;

  const OpenFile file_;
  // Words of a group follow each other, so they are read from a part of the file that is in memory.
  mutable std::vector<std::byte> window_;
  mutable uint64_t window_position_ = 0;
  mutable std::map<uint64_t, std::vector<std::byte>> kept_;  // by position
  mutable uint64_t kept_bytes_ = 0;
};

}  // namespace pelage
