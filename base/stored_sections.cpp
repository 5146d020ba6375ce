// SPDX-License-Identifier: Apache-2.0
#include "base/stored_sections.h"

#include <cerrno>
#include <cstring>

#include <unistd.h>

#include "base/check.h"
#include "base/error.h"

namespace pelage {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* why) {
  throw Error(ErrorKind::kInput, {path.string(), 0, 0}, std::string("cannot read: ") + why);
}

}  // namespace

StoredSections::StoredSections(OpenFile file) : file_(std::move(file)) {
  layout_ = StoredFileLayout::read(path(), file_bytes(),
                                   [&](uint64_t offset, std::span<std::byte> out) { read_at(offset, out); });
}

void StoredSections::read_at(uint64_t offset, std::span<std::byte> out) const {
  for (size_t done = 0; done < out.size();) {
    const ssize_t n =
        ::pread(file_.descriptor(), out.data() + done, out.size() - done, static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(path(), std::strerror(errno));
    if (n == 0) fail(path(), "the file became shorter");
    done += static_cast<size_t>(n);
  }
}

void StoredSections::read(size_t i, std::span<std::byte> out) const {
  const stored_file_format::Section& section = layout_.sections[i];
  PELAGE_CHECK(out.size() == section.bytes);
  read_at(section.offset, out);
  if (content_hash(out) != ContentHash{section.hash_low, section.hash_high})
    refuse_stored_file(path(), "its content does not match its checksum");
}

}  // namespace pelage
