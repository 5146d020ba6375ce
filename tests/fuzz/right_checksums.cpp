// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/right_checksums.h"

#include <algorithm>
#include <cstring>

#include "base/hash.h"
#include "base/stored_file_layout.h"

namespace pelage {

namespace format = stored_file_format;

std::vector<uint8_t> with_right_checksums(std::span<const uint8_t> bytes) {
  std::vector<uint8_t> file(bytes.begin(), bytes.end());
  if (file.size() < sizeof(format::Header) + sizeof(format::Trailer)) return file;
  const uint64_t room = file.size() - sizeof(format::Trailer);
  const auto checksum = [&](uint64_t offset, uint64_t count) {
    return content_hash(std::as_bytes(std::span(file).subspan(offset, count)));
  };

  format::Header header;
  std::memcpy(&header, file.data(), sizeof(header));
  const format::Header good;
  header.magic = good.magic, header.version = good.version, header.byte_order = good.byte_order;
  std::copy(std::begin(good.reserved), std::end(good.reserved), header.reserved);
  std::memcpy(file.data(), &header, sizeof(header));

  format::Trailer trailer;
  std::memcpy(&trailer, file.data() + room, sizeof(trailer));
  trailer.section_count =
      std::min<uint64_t>(trailer.section_count, (room - sizeof(format::Header)) / sizeof(format::Section));
  const uint64_t table_bytes = trailer.section_count * sizeof(format::Section);
  trailer.table_offset = room - table_bytes;
  for (uint64_t i = 0; i < trailer.section_count; ++i) {
    format::Section section;
    uint8_t* const entry = file.data() + trailer.table_offset + i * sizeof(section);
    std::memcpy(&section, entry, sizeof(section));
    section.offset = std::clamp<uint64_t>(section.offset, sizeof(format::Header), trailer.table_offset) /
                     format::kAlignment * format::kAlignment;
    section.bytes = std::min(section.bytes, trailer.table_offset - section.offset);
    const ContentHash hash = checksum(section.offset, section.bytes);
    section.hash_low = hash.low, section.hash_high = hash.high;
    std::memcpy(entry, &section, sizeof(section));
  }
  const ContentHash table = checksum(trailer.table_offset, table_bytes);
  trailer.table_low = table.low, trailer.table_high = table.high;
  trailer.file_bytes = file.size();
  trailer.magic = format::kEndMagic;
  std::memcpy(file.data() + room, &trailer, sizeof(trailer));
  return file;
}

}  // namespace pelage
