// SPDX-License-Identifier: Apache-2.0
#include "base/temporary_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pelage {
namespace {

constexpr int kMaxAttempts = 100;
constexpr size_t kLongestHost = 64, kLongestEnding = 64;

void keep_name_characters(std::string& text) {
  std::erase_if(text, [](char c) {
    return !((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
             c == '.');
  });
  text.resize(std::min(text.size(), kLongestHost));
}

std::string random_digits() {
  uint64_t bits = 0;
  if (::getentropy(&bits, sizeof bits) != 0) bits = static_cast<uint64_t>(::getpid());
  std::array<char, 16> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), bits, 16).ptr;
  return {digits.data(), end};
}

bool same_file(const struct stat& a, const struct stat& b) {
  return a.st_ino == b.st_ino && a.st_dev == b.st_dev;
}

bool still_named(int descriptor, const std::filesystem::path& path) {
  struct stat held {
  }, named{};
  return ::fstat(descriptor, &held) == 0 && ::lstat(path.c_str(), &named) == 0 && same_file(held, named);
}

/// The process id in ".pelage-HOST-PROCESS-...", if the host is this machine.
std::optional<pid_t> writer_here(std::string_view name, std::string_view host) {
  if (host.empty() || !name.starts_with(kTemporaryPrefix)) return {};
  name.remove_prefix(kTemporaryPrefix.size());
  if (!name.starts_with(host) || !name.substr(host.size()).starts_with('-')) return {};
  name.remove_prefix(host.size() + 1);
  pid_t process = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), process);
  const bool whole = error == std::errc() && end != name.data() + name.size() && *end == '-';
  return whole && process > 0 ? std::optional(process) : std::nullopt;
}

bool is_gone(pid_t process) { return ::kill(process, 0) != 0 && errno == ESRCH; }

void remove_if_dead(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) return;
  struct stat info {};
  // The process of its writer may not be visible from here (another container): then the lock is held.
  if (::fstat(descriptor, &info) == 0 && S_ISREG(info.st_mode) && info.st_uid == ::geteuid() &&
      ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && still_named(descriptor, path)) {
    ::unlink(path.c_str());
  }
  ::close(descriptor);
}

}  // namespace

// The name of the machine or, since many are called "localhost", the number that its system generated at
// boot.
std::string machine_name() {
  std::array<char, 256> buffer{};
  std::string name;
  if (::gethostname(buffer.data(), buffer.size() - 1) == 0) name = buffer.data();
  keep_name_characters(name);
  if (!name.empty() && !name.starts_with("localhost")) return name;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> name;
  keep_name_characters(name);
  return name;
}

TemporaryFile create_temporary(const std::filesystem::path& target) {
  std::string ending = target.extension().string();
  if (ending.size() > kLongestEnding) ending.clear();
  const std::string stem =
      std::string(kTemporaryPrefix) + machine_name() + "-" + std::to_string(::getpid()) + "-";
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    TemporaryFile file{target.parent_path() / (stem + random_digits() + ending), -1};
    file.descriptor = ::open(file.path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file.descriptor < 0 && errno == EEXIST) continue;
    if (file.descriptor < 0) return file;
    // A sweep may happen between creation and locking; then the name is gone. File systems without locks are
    // never swept.
    while (::flock(file.descriptor, LOCK_EX) != 0 && errno == EINTR) {
    }
    if (still_named(file.descriptor, file.path)) return file;
    ::close(file.descriptor);
  }
  errno = EAGAIN;
  return {};
}

void sweep_temporaries(const std::filesystem::path& folder) {
  const std::string host = machine_name();
  std::vector<std::filesystem::path> dead;
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder.empty() ? "." : folder, error), end; !error && at != end;
       at.increment(error)) {
    const std::optional<pid_t> writer = writer_here(at->path().filename().string(), host);
    if (writer && is_gone(*writer)) dead.push_back(at->path());
  }
  for (const std::filesystem::path& path : dead) remove_if_dead(path);
}

}  // namespace pelage
