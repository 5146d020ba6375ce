// SPDX-License-Identifier: Apache-2.0
#include "base/file.h"

#include <cctype>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/temporary_file.h"

namespace pelage {
namespace {

std::string reason() { return std::strerror(errno); }

[[noreturn]] void fail_read(const std::filesystem::path& path, const std::string& why) {
  throw Error(ErrorKind::kInput, {path.string(), 0, 0}, "cannot read: " + why);
}

[[noreturn]] void fail_write(const std::filesystem::path& path, const std::string& why) {
  throw Error(ErrorKind::kFailed, {path.string(), 0, 0}, "cannot write: " + why);
}

/// Follows links as target_of_links() does. Returns an empty text, or the reason why that is not possible.
std::string follow_links(std::filesystem::path& path) {
  constexpr int kMaxLinks = 40;  // the kernel's limit
  struct stat link {};
  for (int i = 0; ::lstat(path.c_str(), &link) == 0 && S_ISLNK(link.st_mode); ++i) {
    if (i == kMaxLinks) return "too many symbolic links";
    if (link.st_uid != ::geteuid() && link.st_uid != 0) return "it is a symbolic link of another user";
    std::error_code error;
    const std::filesystem::path target = std::filesystem::read_symlink(path, error);
    if (error) return error.message();
    path = path.parent_path() / target;  // an absolute target replaces the whole path
  }
  return {};
}

bool has_contents(const std::filesystem::path& path, std::string_view expected) {
  try {
    return read_file(path) == expected;
  } catch (const Error&) {
    return false;  // removed, or replaced by something that is no file
  }
}

}  // namespace

ContentHash file_hash(const std::filesystem::path& path) {
  constexpr size_t kPiece = size_t(256) << 10;
  const OpenFile file(path);
  ContentHasher hasher;
  std::vector<std::byte> piece(kPiece);
  for (;;) {
    const ssize_t read = ::read(file.descriptor(), piece.data(), piece.size());
    if (read == 0) return hasher.digest();
    if (read > 0) {
      hasher.add_bytes(std::span(piece).first(static_cast<size_t>(read)));
    } else if (errno != EINTR) {
      throw Error(ErrorKind::kInput, {path.string(), 0, 0},
                  std::string("cannot read: ") + std::strerror(errno));
    }
  }
}

std::string read_file(const std::filesystem::path& path, size_t limit, OpenFile::Links links) {
  const OpenFile file(path, links);
  if (file.bytes() > limit) {
    fail_read(path,
              std::to_string(file.bytes()) + " bytes; the limit is " + std::to_string(limit) + " bytes");
  }
  std::string contents(file.bytes(), '\0');
  size_t done = 0;
  while (done < contents.size()) {
    const ssize_t n = ::read(file.descriptor(), contents.data() + done, contents.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_read(path, reason());
    if (n == 0) break;
    done += static_cast<size_t>(n);
  }
  contents.resize(done);
  return contents;
}

std::string_view foreign_contents(std::string_view beginning) {
  return beginning.starts_with("version https://git-lfs") ? "is a git-lfs pointer, not the file itself" : "";
}

std::string_view foreign_text(std::string_view beginning) {
  const auto zero = [&](size_t i) { return beginning[i] == '\0'; };
  const bool marked = beginning.starts_with("\xff\xfe") || beginning.starts_with("\xfe\xff");
  // Without a mark, one byte of each of the first two characters is zero.
  const bool halves = beginning.size() >= 4 && zero(0) != zero(1) && zero(0) == zero(2) &&
                      zero(1) == zero(3) &&
                      ((beginning[0] | beginning[1] | beginning[2] | beginning[3]) & 0x80) == 0;
  return marked || halves ? "is text in UTF-16; save it as UTF-8" : foreign_contents(beginning);
}

std::string read_text_file(const std::filesystem::path& path, size_t limit) {
  std::string text = read_file(path, limit);
  if (const std::string_view foreign = foreign_text(text); !foreign.empty())
    throw Error(ErrorKind::kInput, {path.string(), 0, 0}, std::string(foreign));
  if (text.starts_with(kUtf8Mark)) text.erase(0, kUtf8Mark.size());
  return text;
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

std::string file_problem(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::status_known(status)) return "cannot read: " + error.message();
  if (!std::filesystem::exists(status)) return "there is no such file";
  return std::filesystem::is_regular_file(status) ? "" : "is not a regular file";
}

std::filesystem::path target_of_links(const std::filesystem::path& path) {
  std::filesystem::path target = path;
  if (const std::string why = follow_links(target); !why.empty()) fail_write(path, why);
  return target;
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  struct stat one {
  }, other{};
  if (::stat(a.c_str(), &one) == 0 && ::stat(b.c_str(), &other) == 0)
    return one.st_ino == other.st_ino && one.st_dev == other.st_dev;
  std::filesystem::path target_a = a, target_b = b;
  if (!follow_links(target_a).empty() || !follow_links(target_b).empty()) return false;
  std::error_code error_a, error_b;
  const auto place_a = std::filesystem::weakly_canonical(std::filesystem::absolute(target_a), error_a);
  const auto place_b = std::filesystem::weakly_canonical(std::filesystem::absolute(target_b), error_b);
  return !error_a && !error_b && place_a == place_b;
}

AtomicFile::AtomicFile(std::filesystem::path path, Links links) : named_(std::move(path)) {
  path_ = links == Links::kFollow ? target_of_links(named_) : named_;
  if (path_.filename().empty()) fail_write(named_, "the path names no file");
  struct stat old {};
  const bool replaces = ::lstat(path_.c_str(), &old) == 0;
  if (replaces && !S_ISREG(old.st_mode) && !S_ISLNK(old.st_mode))
    fail_write(named_, S_ISDIR(old.st_mode) ? "it is a folder" : "it is not a regular file");
  if (path_.has_parent_path()) {
    std::error_code ignored;
    // If a link leads to a missing folder, a disk may not be mounted: creating the folder would hide that.
    if (path_ != named_ && !std::filesystem::exists(path_.parent_path(), ignored))
      fail_write(named_, "it is a link to " + path_.string() + ", whose folder does not exist");
    std::filesystem::create_directories(path_.parent_path(), ignored);
  }
  TemporaryFile file = create_temporary(path_);
  if (file.descriptor < 0) fail_write(named_, reason());
  descriptor_ = file.descriptor;
  temporary_ = std::move(file.path);
  if (links == Links::kReplace || !replaces) return;
  // Without the permission to change the owner, the new one is kept.
  [[maybe_unused]] const int given = ::fchown(descriptor_, old.st_uid, old.st_gid);
  ::fchmod(descriptor_, old.st_mode & 0777);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_write(named_, reason());
    bytes = bytes.subspan(static_cast<size_t>(n));
  }
}

void AtomicFile::write_at(uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_write(named_, reason());
    bytes = bytes.subspan(static_cast<size_t>(n));
    offset += static_cast<uint64_t>(n);
  }
}

void AtomicFile::write(std::string_view text) { write(std::as_bytes(std::span(text.data(), text.size()))); }

void AtomicFile::sync() {
  // fsync also covers what a library wrote through temporary_path(), because it is the same file.
  if (::fsync(descriptor_) != 0 && errno != EINVAL) fail_write(named_, reason());
}

void AtomicFile::commit() {
  sync();
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail_write(named_, reason());
  temporary_.clear();
}

bool AtomicFile::commit_over(std::string_view expected) {
  sync();  // before the comparison, because it takes milliseconds
  if (!has_contents(path_, expected)) return false;
  const auto exchange = [this] {
    return ::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, path_.c_str(), RENAME_EXCHANGE) == 0;
  };
  if (!exchange()) {
    if (errno == ENOENT) return false;  // removed meanwhile
    if (errno != EINVAL && errno != ENOSYS) fail_write(named_, reason());
    if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail_write(named_, reason());
    temporary_.clear();
    return true;
  }
  if (has_contents(temporary_, expected)) return true;  // the destructor removes the old file
  // Another program saved the file between the comparison and the exchange. Its file returns to the path. If
  // the program has saved once more, the exchange took that file, and the next one brings it back.
  struct stat own {
  }, taken{};
  if (!exchange() || ::fstat(descriptor_, &own) != 0) {
    const std::string why = reason();
    temporary_.clear();  // it may be the file of the other program
    fail_write(named_, why);
  }
  if (::stat(temporary_.c_str(), &taken) == 0 && taken.st_ino != own.st_ino && !exchange())
    fail_write(named_, reason());
  return false;
}

void write_file(const std::filesystem::path& path, std::string_view bytes, Links links) {
  AtomicFile file(path, links);
  file.write(bytes);
  file.commit();
}

void make_own_folder(const std::filesystem::path& path) {
  std::error_code failed;
  std::filesystem::create_directories(path, failed);
  if (failed) fail_write(path, failed.message());
  if (std::filesystem::is_symlink(path, failed)) fail_write(path, "it is a symbolic link");
}

}  // namespace pelage
