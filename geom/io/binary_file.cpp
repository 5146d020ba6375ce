// SPDX-License-Identifier: Apache-2.0
#include "geom/io/binary_file.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"

namespace pelage {

static_assert(std::endian::native == std::endian::little, "a strand file is mapped into memory as it is");

BinaryFile::BinaryFile(const std::filesystem::path& path) : path_(path) {
  if (const std::string problem = file_problem(path); !problem.empty()) fail(problem);
  std::error_code error;
  descriptor_.number = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  size_ = std::filesystem::file_size(path, error);
  if (descriptor_.number < 0 || error) fail("cannot be opened");
  if (size_ == 0) fail("is empty");
  std::string beginning(std::min<uint64_t>(size_, 64), '\0');
  read_bytes(0, beginning.data(), beginning.size());
  if (const std::string_view foreign = foreign_contents(beginning); !foreign.empty())
    fail(std::string(foreign));
}

void BinaryFile::require(uint64_t offset, uint64_t count, uint64_t value_size,
                         const std::string& what) const {
  if (offset <= size_ && count <= (size_ - offset) / value_size) return;
  fail("claims " + std::to_string(count) + " " + what + " at byte " + std::to_string(offset) +
       ", but has only " + std::to_string(size_) + " bytes");
}

BinaryFile::Descriptor::~Descriptor() {
  if (number >= 0) ::close(number);
}

void BinaryFile::read_bytes(uint64_t offset, void* to, size_t count) const {
  size_t done = 0;
  while (done < count) {
    const ssize_t got = ::pread(descriptor_.number, static_cast<char*>(to) + done, count - done,
                                static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) fail("cannot be read at byte " + std::to_string(offset + done));
    done += static_cast<size_t>(got);
  }
}

void BinaryFile::fail(const std::string& why) const {
  throw Error(ErrorKind::kInput, {path_.string(), 0, 0}, why);
}

}  // namespace pelage
