// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>

#include "base/open_file.h"
#include "base/stored_file_layout.h"

namespace pelage {

/// A file of a content store that is larger than memory may be: its sections are read when they are asked
/// for, into memory of the caller's, and checked each time. Nothing is mapped, and the system is asked to
/// keep no copy of what was read, so that all that stays resident is what the caller holds.
///
/// Thread safety: const members may be called from any thread.
class StoredSections {
 public:
  /// Reads and checks header and table. Throws Error (kInput) that says what is wrong.
  explicit StoredSections(std::filesystem::path path) : StoredSections(OpenFile(std::move(path))) {}
  explicit StoredSections(OpenFile file);

  const std::filesystem::path& path() const { return file_.path(); }
  const std::string& kind() const { return layout_.kind; }
  const ContentHash& key() const { return layout_.key; }
  size_t section_count() const { return layout_.sections.size(); }
  uint64_t section_bytes(size_t i) const { return layout_.sections[i].bytes; }
  uint64_t file_bytes() const { return file_.bytes(); }
  /// What this object holds.
  size_t bytes() const { return layout_.sections.capacity() * sizeof(layout_.sections[0]); }

  /// Reads section `i` into `out`, which is as long as it. Throws Error (kInput) when it cannot be read or is
  /// not what was written.
  void read(size_t i, std::span<std::byte> out) const;
  /// Says that section `i` will be read soon: the system may fetch it meanwhile. Until it is read, the system
  /// keeps that copy.
  void prefetch(size_t i) const;

 private:
  void read_at(uint64_t offset, std::span<std::byte> out) const;

  OpenFile file_;
  StoredFileLayout layout_;
};

}  // namespace pelage
