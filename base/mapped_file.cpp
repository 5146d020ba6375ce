// SPDX-License-Identifier: Apache-2.0
#include "base/mapped_file.h"

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include <sys/mman.h>

#include "base/error.h"

namespace pelage {

MappedFile::MappedFile(const OpenFile& file) {
  if (file.bytes() == 0) return;
  void* at = ::mmap(nullptr, file.bytes(), PROT_READ, MAP_SHARED, file.descriptor(), 0);
  if (at == MAP_FAILED) {
    throw Error(ErrorKind::kInput, {file.path().string(), 0, 0},
                std::string("cannot read: ") + std::strerror(errno));
  }
  bytes_ = {static_cast<const std::byte*>(at), file.bytes()};
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
