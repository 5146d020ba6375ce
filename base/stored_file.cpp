// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <fstream>

#include "base/content_store.h"
#include "base/error.h"
#include "base/stored_file_format.h"

namespace pelage {

namespace format = stored_file_format;

namespace {

template <class T>
T read_at(std::span<const std::byte> bytes, uint64_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

}  // namespace

StoredFile::StoredFile(const std::filesystem::path& path) : file_(path) {
  const std::span<const std::byte> bytes = file_.bytes();
  const auto refuse = [&](const char* why) {
    throw Error(ErrorKind::kInput, {path.string(), 0, 0}, std::string("damaged cache file: ") + why);
  };
  if (bytes.size() < sizeof(format::Header) + sizeof(format::Trailer)) refuse("it is too short");
  const auto header = read_at<format::Header>(bytes, 0);
  if (header.magic != format::kMagic) refuse("it is not one of Pelage");
  if (header.byte_order != format::kByteOrder) refuse("it is from a machine of the other byte order");
  if (header.version != format::kVersion) refuse("it is of another version");
  if (header.reserved[0] != 0 || header.reserved[1] != 0) refuse("its header is damaged");
  kind_.assign(header.kind, strnlen(header.kind, sizeof(header.kind)));
  if (!std::all_of(header.kind + kind_.size(), std::end(header.kind), [](char c) { return c == 0; }))
    refuse("its header is damaged");
  key_ = {header.key_low, header.key_high};

  const auto trailer = read_at<format::Trailer>(bytes, bytes.size() - sizeof(format::Trailer));
  if (trailer.magic != format::kEndMagic || trailer.file_bytes != bytes.size()) refuse("it is cut off");
  const uint64_t room = bytes.size() - sizeof(format::Trailer);
  if (trailer.table_offset > room || (room - trailer.table_offset) % sizeof(format::Section) != 0 ||
      (room - trailer.table_offset) / sizeof(format::Section) != trailer.section_count) {
    refuse("its table is out of place");
  }
  const ContentHash table_hash =
      content_hash(bytes.subspan(trailer.table_offset, room - trailer.table_offset));
  if (table_hash != ContentHash{trailer.table_low, trailer.table_high}) refuse("its table has changed");
  // What lies between the parts is zeros, so that no byte of the file goes unchecked.
  uint64_t end = sizeof(format::Header);
  const auto padded_to = [&](uint64_t next) {
    if (next < end || next - end >= format::kAlignment) return false;
    const auto gap = bytes.subspan(end, next - end);
    return std::all_of(gap.begin(), gap.end(), [](std::byte b) { return b == std::byte{0}; });
  };
  for (uint64_t i = 0; i < trailer.section_count; ++i) {
    const auto section = read_at<format::Section>(bytes, trailer.table_offset + i * sizeof(format::Section));
    if (section.offset % format::kAlignment != 0 || section.offset > trailer.table_offset ||
        section.bytes > trailer.table_offset - section.offset) {
      refuse("a section is out of place");
    }
    if (!padded_to(section.offset)) refuse("there is something between its sections");
    end = section.offset + section.bytes;
    sections_.push_back(bytes.subspan(section.offset, section.bytes));
    if (content_hash(sections_.back()) != ContentHash{section.hash_low, section.hash_high})
      refuse("its bytes have changed");
  }
  if (!padded_to(trailer.table_offset)) refuse("there is something between its sections");
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
