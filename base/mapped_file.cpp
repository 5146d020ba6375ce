// SPDX-License-Identifier: Apache-2.0
#include "base/mapped_file.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"

namespace pelage {

MappedFile::MappedFile(const std::filesystem::path& path) {
  const auto fail = [&](int descriptor, const std::string& why) {
    if (descriptor >= 0) ::close(descriptor);
    throw Error(ErrorKind::kInput, {path.string(), 0, 0}, "cannot read: " + why);
  };
  // Without O_NONBLOCK a pipe would wait for its writer.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) fail(descriptor, std::strerror(errno));
  struct stat info {};
  if (::fstat(descriptor, &info) != 0) fail(descriptor, std::strerror(errno));
  if (!S_ISREG(info.st_mode)) fail(descriptor, "it is not a regular file");
  const auto size = static_cast<size_t>(info.st_size);
  if (size > 0) {
    void* at = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor, 0);
    if (at == MAP_FAILED) fail(descriptor, std::strerror(errno));
    bytes_ = {static_cast<const std::byte*>(at), size};
  }
  ::close(descriptor);
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

MappedFile::MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(bytes_, other.bytes_);
  return *this;
}

}  // namespace pelage
