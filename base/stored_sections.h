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

/// A file of a content store that may be larger than memory. read() copies one section to memory of the
/// caller and verifies it, each time. The file is not mapped. The system may cache what was read and its
/// neighbours; it frees this cache when it needs memory.
///
/// Thread safety: const members may be called from any thread.
class StoredSections {
 public:
  /// Reads and verifies header and table. Throws Error (kInput) with the reason.
  explicit StoredSections(std::filesystem::path path) : StoredSections(OpenFile(std::move(path))) {}
  explicit StoredSections(OpenFile file);

  const std::filesystem::path& path() const { return file_.path(); }
  const std::string& kind() const { return layout_.kind; }
  const ContentHash& key() const { return layout_.key; }
  size_t section_count() const { return layout_.sections.size(); }
  uint64_t section_bytes(size_t i) const { return layout_.sections[i].bytes; }
  uint64_t file_bytes() const { return file_.bytes(); }
  /// Heap memory of this object.
  size_t bytes() const { return layout_.sections.capacity() * sizeof(layout_.sections[0]); }

  /// Reads section `i` into `out`, which must have section_bytes(i) bytes. Throws Error (kInput) when the
  /// section cannot be read or its checksum is wrong.
  void read(size_t i, std::span<std::byte> out) const;

 private:
  void read_at(uint64_t offset, std::span<std::byte> out) const;

  OpenFile file_;
  StoredFileLayout layout_;
};

}  // namespace pelage
