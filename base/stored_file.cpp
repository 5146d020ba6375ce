// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <fstream>

#include "base/content_store.h"
#include "base/stored_file_layout.h"

namespace pelage {

namespace format = stored_file_format;

StoredFile::StoredFile(const OpenFile& file) : file_(file) {
  const std::filesystem::path& path = file.path();
  const std::span<const std::byte> bytes = file_.bytes();
  const StoredFileLayout layout =
      StoredFileLayout::read(path, bytes.size(), [&](uint64_t offset, std::span<std::byte> out) {
        std::memcpy(out.data(), bytes.data() + offset, out.size());
      });
  kind_ = layout.kind;
  key_ = layout.key;
  // The padding between parts must be zero, so that every byte of the file is verified.
  uint64_t end = sizeof(format::Header);
  const auto padded_to = [&](uint64_t next) {
    if (next < end || next - end >= format::kAlignment) return false;
    const auto gap = bytes.subspan(end, next - end);
    return std::all_of(gap.begin(), gap.end(), [](std::byte b) { return b == std::byte{0}; });
  };
  for (const format::Section& section : layout.sections) {
    if (!padded_to(section.offset)) refuse_stored_file(path, "unknown bytes between its sections");
    end = section.offset + section.bytes;
    sections_.push_back(bytes.subspan(section.offset, section.bytes));
    if (content_hash(sections_.back()) != ContentHash{section.hash_low, section.hash_high})
      refuse_stored_file(path, "its content does not match its checksum");
  }
  if (!padded_to(layout.table_offset)) refuse_stored_file(path, "unknown bytes between its sections");
}

bool is_stored_file(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  uint64_t magic = 0;
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(&magic), sizeof(magic));
  return file.gcount() == sizeof(magic) && magic == format::kMagic;
}

}  // namespace pelage
