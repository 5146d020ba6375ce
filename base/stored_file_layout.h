// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/hash.h"

// Layout of a file of ContentStore: header, sections, table of sections, trailer. Each section starts at a
// multiple of kAlignment bytes; the gaps are filled with zeros. The trailer ends the file. Numbers have the
// byte order of the machine that wrote the file, which Header::byte_order tells.
namespace pelage::stored_file_format {

inline constexpr uint64_t kMagic = 0x686361436c65500aull;  // "\nPelCach"
inline constexpr uint64_t kEndMagic = 0x656c6f6857736910ull;
inline constexpr uint32_t kVersion = 1;
inline constexpr uint32_t kByteOrder = 0x01020304;
inline constexpr uint64_t kAlignment = 64;
inline constexpr const char* kEnding = ".cache";
inline constexpr const char* kLockEnding = ".lock";

struct Header {
  uint64_t magic = kMagic;
  uint32_t version = kVersion;
  uint32_t byte_order = kByteOrder;
  char kind[16] = {};  // padded with zeros
  uint64_t key_low = 0, key_high = 0;
  uint64_t reserved[2] = {};
};
static_assert(sizeof(Header) == kAlignment);

struct Section {
  uint64_t offset = 0, bytes = 0;
  uint64_t hash_low = 0, hash_high = 0;
};
static_assert(sizeof(Section) == 32);

struct Trailer {
  uint64_t table_offset = 0;
  uint64_t section_count = 0;
  uint64_t table_low = 0, table_high = 0;
  uint64_t file_bytes = 0;
  uint64_t magic = kEndMagic;
};
static_assert(sizeof(Trailer) == 48);

}  // namespace pelage::stored_file_format

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
