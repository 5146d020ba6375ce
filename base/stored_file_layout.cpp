// SPDX-License-Identifier: Apache-2.0
#include "base/stored_file_layout.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"

namespace pelage {

namespace format = stored_file_format;

void refuse_stored_file(const std::filesystem::path& path, const char* why) {
  throw Error(ErrorKind::kInput, {path.string(), 0, 0}, std::string("damaged cache file: ") + why);
}

StoredFileLayout StoredFileLayout::read(
    const std::filesystem::path& path, uint64_t file_bytes,
    const std::function<void(uint64_t offset, std::span<std::byte>)>& read) {
  const auto refuse = [&](const char* why) { refuse_stored_file(path, why); };
  if (file_bytes < sizeof(format::Header) + sizeof(format::Trailer)) refuse("it is too short");
  format::Header header;
  read(0, std::as_writable_bytes(std::span(&header, 1)));
  if (header.magic != format::kMagic) refuse("it is not a Pelage file");
  if (header.byte_order != format::kByteOrder) refuse("it comes from a machine with the other byte order");
  if (header.version != format::kVersion) refuse("it has another format version");
  if (header.reserved[0] != 0 || header.reserved[1] != 0) refuse("its header is damaged");
  StoredFileLayout layout;
  layout.kind.assign(header.kind, strnlen(header.kind, sizeof(header.kind)));
  if (!std::all_of(header.kind + layout.kind.size(), std::end(header.kind), [](char c) { return c == 0; }))
    refuse("its header is damaged");
  layout.key = {header.key_low, header.key_high};

  const uint64_t room = file_bytes - sizeof(format::Trailer);
  format::Trailer trailer;
  read(room, std::as_writable_bytes(std::span(&trailer, 1)));
  if (trailer.magic != format::kEndMagic || trailer.file_bytes != file_bytes) refuse("it is truncated");
  if (trailer.table_offset > room || (room - trailer.table_offset) % sizeof(format::Section) != 0 ||
      (room - trailer.table_offset) / sizeof(format::Section) != trailer.section_count) {
    refuse("its table is misplaced");
  }
  layout.table_offset = trailer.table_offset;
  layout.sections.resize(trailer.section_count);
  const auto table = std::as_writable_bytes(std::span(layout.sections));
  if (!table.empty()) read(trailer.table_offset, table);
  if (content_hash(table) != ContentHash{trailer.table_low, trailer.table_high})
    refuse("its table does not match its checksum");
  for (const format::Section& section : layout.sections) {
    if (section.offset % format::kAlignment != 0 || section.offset < sizeof(format::Header) ||
        section.offset > trailer.table_offset || section.bytes > trailer.table_offset - section.offset) {
      refuse("a section is misplaced");
    }
  }
  return layout;
}

}  // namespace pelage
