// SPDX-License-Identifier: Apache-2.0
#include "base/file.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"

namespace pelage {

namespace {

std::string reason() { return std::strerror(errno); }

[[noreturn]] void fail_read(const std::filesystem::path& path, const std::string& why) {
  throw Error(ErrorKind::kInput, {path.string(), 0, 0}, "cannot read: " + why);
}

[[noreturn]] void fail_write(const std::filesystem::path& path, const std::string& why) {
  throw Error(ErrorKind::kFailed, {path.string(), 0, 0}, "cannot write: " + why);
}

// A rename would put a file where a device, a pipe or a link stood: links are followed, the others refused.
void replace_only_files(std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return;
  if (!std::filesystem::is_regular_file(status)) fail_write(path, "it is not a regular file");
  if (std::filesystem::is_symlink(path, error)) path = std::filesystem::canonical(path);
}

struct Descriptor {
  int fd;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
};

}  // namespace

std::string read_file(const std::filesystem::path& path, size_t limit) {
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (file.fd < 0) fail_read(path, reason());
  struct stat info {};
  if (::fstat(file.fd, &info) != 0) fail_read(path, reason());
  if (S_ISDIR(info.st_mode)) fail_read(path, "it is a folder");
  if (!S_ISREG(info.st_mode)) fail_read(path, "it is not a regular file");
  if (static_cast<size_t>(info.st_size) > limit) {
    fail_read(path,
              std::to_string(info.st_size) + " bytes, at most " + std::to_string(limit) + " are accepted");
  }
  std::string contents(static_cast<size_t>(info.st_size), '\0');
  size_t done = 0;
  while (done < contents.size()) {
    const ssize_t n = ::read(file.fd, contents.data() + done, contents.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_read(path, reason());
    if (n == 0) break;
    done += static_cast<size_t>(n);
  }
  contents.resize(done);
  return contents;
}

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)) {
  replace_only_files(path_);
  std::error_code ignored;
  if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path(), ignored);
  // Beside the target, so that the rename stays on one file system; the ending is kept for libraries that
  // look at it.
  std::string pattern =
      path_.parent_path() / ("." + path_.stem().string() + ".XXXXXX" + path_.extension().string());
  descriptor_ = ::mkostemps(pattern.data(), static_cast<int>(path_.extension().string().size()), O_CLOEXEC);
  if (descriptor_ < 0) fail_write(path_, reason());
  const mode_t mask = ::umask(0);
  ::umask(mask);
  ::fchmod(descriptor_, 0666 & ~mask);
  temporary_ = pattern;
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_write(path_, reason());
    bytes = bytes.subspan(static_cast<size_t>(n));
  }
}

void AtomicFile::write(std::string_view text) { write(std::as_bytes(std::span(text.data(), text.size()))); }

void AtomicFile::commit() {
  // fsync also reaches what a library wrote through temporary_path(): it is the same file.
  if (::fsync(descriptor_) != 0 && errno != EINVAL) fail_write(path_, reason());
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail_write(path_, reason());
  temporary_.clear();
}

}  // namespace pelage
