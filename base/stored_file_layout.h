// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/hash.h"
#include "base/stored_file_format.h"

namespace pelage {

/// Header and table of sections of a file of a content store, both verified. The contents of the sections are
/// not verified.
struct StoredFileLayout {
  std::string kind;
  ContentHash key;
  uint64_t table_offset = 0;
  std::vector<stored_file_format::Section> sections;

  /// Reads and verifies header and table. `read` must fill the span with the bytes of the file that start at
  /// `offset`; it is never called for bytes beyond `file_bytes`, the length of the file. Throws Error
  /// (kInput) with the reason.
  static StoredFileLayout read(const std::filesystem::path& path, uint64_t file_bytes,
                               const std::function<void(uint64_t offset, std::span<std::byte>)>& read);
};

/// Throws Error (kInput) for a damaged file: "PATH: damaged cache file: WHY".
[[noreturn]] void refuse_stored_file(const std::filesystem::path& path, const char* why);

}  // namespace pelage
