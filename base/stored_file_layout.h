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

/// Verified header and table of a content store's file. The sections are not verified.
struct StoredFileLayout {
  std::string kind;
  ContentHash key;
  uint64_t table_offset = 0;
  std::vector<stored_file_format::Section> sections;

  /// `read` fills the span with the bytes of the file from an offset on; it is never called for bytes beyond
  /// `file_bytes`. Throws Error (kInput) with the reason.
  static StoredFileLayout read(const std::filesystem::path& path, uint64_t file_bytes,
                               const std::function<void(uint64_t offset, std::span<std::byte>)>& read);
};

/// Throws the error for a damaged file: "PATH: damaged cache file: WHY".
[[noreturn]] void refuse_stored_file(const std::filesystem::path& path, const char* why);

}  // namespace pelage
