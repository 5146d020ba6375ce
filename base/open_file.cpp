// SPDX-License-Identifier: Apache-2.0
#include "base/open_file.h"

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"

namespace pelage {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& why) {
  throw Error(ErrorKind::kInput, {path.string(), 0, 0}, "cannot read: " + why);
}

}  // namespace

OpenFile::OpenFile(std::filesystem::path path, Links links) : path_(std::move(path)) {
  // Without O_NONBLOCK, opening a pipe would wait for its writer.
  const int refused = links == Links::kRefuse ? O_NOFOLLOW : 0;
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | refused);
  if (descriptor_ < 0) {
    const bool is_link = refused != 0 && errno == ELOOP;
    fail(path_, is_link ? "it is a symbolic link" : std::strerror(errno));
  }
  struct stat info {};
  const bool known = ::fstat(descriptor_, &info) == 0;
  if (!known || !S_ISREG(info.st_mode)) {
    const std::string why = !known                  ? std::strerror(errno)
                            : S_ISDIR(info.st_mode) ? "it is a folder"
                                                    : "it is not a regular file";
    ::close(descriptor_);
    fail(path_, why);
  }
  bytes_ = static_cast<size_t>(info.st_size);
  owner_ = info.st_uid;
}

OpenFile::~OpenFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

OpenFile::OpenFile(OpenFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      bytes_(other.bytes_),
      owner_(other.owner_) {}

OpenFile& OpenFile::operator=(OpenFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(bytes_, other.bytes_);
  std::swap(owner_, other.owner_);
  return *this;
}

}  // namespace pelage
