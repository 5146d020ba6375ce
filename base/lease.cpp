// SPDX-License-Identifier: Apache-2.0
#include "base/lease.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <random>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/temporary_file.h"

namespace pelage {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kPoll = std::chrono::milliseconds(10), kMaxPoll = std::chrono::milliseconds(500);

std::string random_name() {
  std::random_device device;
  return fmt::format("{:08x}{:08x}", device(), device());
}

bool names_open_file(int descriptor, const std::filesystem::path& path) {
  struct stat held {
  }, named{};
  return ::fstat(descriptor, &held) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         held.st_ino == named.st_ino && held.st_dev == named.st_dev;
}

std::string content_of(int descriptor) {
  std::array<char, 512> buffer{};
  const ssize_t size = ::pread(descriptor, buffer.data(), buffer.size(), 0);
  return size > 0 ? std::string(buffer.data(), static_cast<size_t>(size)) : std::string();
}

class OwnedDescriptor {
 public:
  explicit OwnedDescriptor(int number) : number_(number) {}
  ~OwnedDescriptor() {
    if (number_ >= 0) ::close(number_);
  }
  OwnedDescriptor(const OwnedDescriptor&) = delete;
  OwnedDescriptor& operator=(const OwnedDescriptor&) = delete;
  int number() const { return number_; }
  int release() { return std::exchange(number_, -1); }

 private:
  int number_;
};

/// What a process that waits saw in the file, and since when.
struct Seen {
  ino_t file = 0;
  std::string content;
  Clock::time_point since;
};

/// Opening the file anew shows what its holder has flushed, also on NFS.
int open_again(const std::filesystem::path& path) {
  const int flags = O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
  const int descriptor = ::open(path.c_str(), O_RDWR | flags);  // NFS locks exclusively only what is writable
  return descriptor < 0 && errno == EACCES ? ::open(path.c_str(), O_RDONLY | flags) : descriptor;
}

std::string content_of(const std::filesystem::path& path) {
  const OwnedDescriptor file(open_again(path));
  return file.number() < 0 ? std::string() : content_of(file.number());
}

/// Whether the last call failed because the file is no longer there.
bool file_is_gone() { return errno == ENOENT || errno == ESTALE; }

/// Removes the lease if it still has the content that was seen, and not that of a new holder. Returns false
/// if the folder does not let this process remove it.
bool remove_expired(const std::filesystem::path& path, const std::string& content) {
  if (content_of(path) != content) return true;
  const std::filesystem::path aside =
      path.parent_path() / (path.stem().string() + "." + random_name() + path.extension().string());
  if (::rename(path.c_str(), aside.c_str()) != 0) return file_is_gone();
  // A new holder may have come between: its lease is put back.
  if (content_of(aside) != content) (void)!::link(aside.c_str(), path.c_str());
  ::unlink(aside.c_str());
  return true;
}

/// Looks at a lease that another holder has, and removes it if that holder is gone. Returns false if this
/// process may not: waiting would then have no end.
bool look(const std::filesystem::path& path, const LeaseTiming& timing, Seen& seen) {
  const OwnedDescriptor file(open_again(path));
  struct stat info {};
  if (file.number() < 0 || ::fstat(file.number(), &info) != 0) return file_is_gone();
  std::string content = content_of(file.number());
  const bool is_of_this_machine = content.starts_with(machine_name() + " ");
  // The holder locks the file before it writes its name.
  if (is_of_this_machine && ::flock(file.number(), LOCK_EX | LOCK_NB) == 0) {
    if (!names_open_file(file.number(), path)) return true;
    return ::unlink(path.c_str()) == 0 || file_is_gone();
  }
  const auto now = Clock::now();
  if (seen.file != info.st_ino || seen.content != content) {
    seen = {info.st_ino, std::move(content), now};
  } else if (now - seen.since > timing.expiry) {
    const std::string expired = std::exchange(seen, {}).content;
    return remove_expired(path, expired);
  }
  return true;
}

}  // namespace

Lease::Lease(std::filesystem::path path, int descriptor, std::string owner, const LeaseTiming& timing)
    : path_(std::move(path)), descriptor_(descriptor), owner_(std::move(owner)), timing_(timing) {
  write_count();
  thread_ = std::thread([this] { renew(); });
}

Lease::~Lease() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  wake_.notify_all();
  thread_.join();
  // While it is still locked. It may have expired, and belong to another holder.
  if (names_open_file(descriptor_, path_)) ::unlink(path_.c_str());
  ::close(descriptor_);
}

bool Lease::write_count() {
  const std::string text = fmt::format("{}{:020}\n", owner_, ++count_);
  return ::pwrite(descriptor_, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()) &&
         ::fsync(descriptor_) == 0;
}

void Lease::renew() {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, timing_.renewal, [this] { return ending_; })) {
    lock.unlock();
    const bool mine = names_open_file(descriptor_, path_);
    if (mine) write_count();  // after a failure, the lease expires
    lock.lock();
    if (!mine) return;
  }
}

std::unique_ptr<Lease> Lease::take(const std::filesystem::path& path, const std::function<bool()>& cancelled,
                                   std::chrono::milliseconds patience, const LeaseTiming& timing) {
  const auto give_up = Clock::now() + patience;
  const std::string owner = fmt::format("{} {} {}\n", machine_name(), ::getpid(), random_name());
  Seen seen;
  for (auto poll = kPoll;; poll = std::min(2 * poll, kMaxPoll)) {
    OwnedDescriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666));
    if (file.number() >= 0) {
      ::flock(file.number(), LOCK_EX | LOCK_NB);  // an empty file is not taken for that of a dead process
      if (names_open_file(file.number(), path))
        return std::unique_ptr<Lease>(new Lease(path, file.release(), owner, timing));
      continue;
    }
    if (errno != EEXIST) return nullptr;
    if (!look(path, timing, seen)) return nullptr;
    if (cancelled() || Clock::now() >= give_up) return nullptr;
    std::this_thread::sleep_for(poll);
  }
}

}  // namespace pelage
