// SPDX-License-Identifier: Apache-2.0
#include "base/stored_sections.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/check.h"
#include "base/error.h"

namespace pelage {
namespace {

constexpr uint64_t kSystemPage = 4096;

[[noreturn]] void fail(const std::filesystem::path& path, const char* why) {
  throw Error(ErrorKind::kInput, {path.string(), 0, 0}, std::string("cannot read: ") + why);
}

}  // namespace

StoredSections::StoredSections(std::filesystem::path path) : path_(std::move(path)) {
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) fail(path_, std::strerror(errno));
  try {
    struct stat info {};
    if (::fstat(descriptor_, &info) != 0) fail(path_, std::strerror(errno));
    if (!S_ISREG(info.st_mode)) fail(path_, "it is not a regular file");
    file_bytes_ = static_cast<uint64_t>(info.st_size);
    // Reading ahead would fetch neighbours that nobody asked for.
    ::posix_fadvise(descriptor_, 0, 0, POSIX_FADV_RANDOM);
    layout_ = StoredFileLayout::read(
        path_, file_bytes_, [&](uint64_t offset, std::span<std::byte> out) { read_at(offset, out); });
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

StoredSections::~StoredSections() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

StoredSections::StoredSections(StoredSections&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      file_bytes_(other.file_bytes_),
      layout_(std::move(other.layout_)) {}

StoredSections& StoredSections::operator=(StoredSections&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(file_bytes_, other.file_bytes_);
  std::swap(layout_, other.layout_);
  return *this;
}

void StoredSections::read_at(uint64_t offset, std::span<std::byte> out) const {
  for (size_t done = 0; done < out.size();) {
    const ssize_t n =
        ::pread(descriptor_, out.data() + done, out.size() - done, static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(path_, std::strerror(errno));
    if (n == 0) fail(path_, "it has become shorter");
    done += static_cast<size_t>(n);
  }
}

void StoredSections::read(size_t i, std::span<std::byte> out) const {
  const stored_file_format::Section& section = layout_.sections[i];
  PELAGE_CHECK(out.size() == section.bytes);
  read_at(section.offset, out);
  const uint64_t begin = section.offset / kSystemPage * kSystemPage;
  ::posix_fadvise(descriptor_, static_cast<off_t>(begin),
                  static_cast<off_t>(section.offset + section.bytes - begin), POSIX_FADV_DONTNEED);
  if (content_hash(out) != ContentHash{section.hash_low, section.hash_high})
    refuse_stored_file(path_, "its bytes have changed");
}

void StoredSections::expect(size_t i) const {
  const stored_file_format::Section& section = layout_.sections[i];
  ::posix_fadvise(descriptor_, static_cast<off_t>(section.offset), static_cast<off_t>(section.bytes),
                  POSIX_FADV_WILLNEED);
}

}  // namespace pelage
