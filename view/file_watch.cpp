// SPDX-License-Identifier: Apache-2.0
#include "view/file_watch.h"

#include <cstddef>
#include <cstdint>
#include <cstring>

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <unistd.h>

#include "base/error.h"

namespace pelage {

FileWatch::FileWatch()
    : inotify_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)), event_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (inotify_ >= 0 && event_ >= 0) return;
  if (inotify_ >= 0) ::close(inotify_);
  if (event_ >= 0) ::close(event_);
  throw Error(ErrorKind::kFailed, "the system cannot watch more files (fs.inotify.max_user_instances)");
}

FileWatch::~FileWatch() {
  ::close(inotify_);
  ::close(event_);
}

void FileWatch::watch(const std::vector<std::filesystem::path>& files) {
  std::map<int, std::set<std::string>> names;
  const auto add = [&](const std::filesystem::path& file) {
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    constexpr uint32_t kEvents = IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE | IN_ONLYDIR;
    const int watched = ::inotify_add_watch(inotify_, folder.c_str(), kEvents);
    if (watched >= 0) names[watched].insert(file.filename().string());
  };
  for (const std::filesystem::path& file : files) {
    add(file);
    std::error_code failed;
    const std::filesystem::path target = std::filesystem::weakly_canonical(file, failed);
    if (!failed && target != file) add(target);
  }
  for (const auto& [watched, unused] : names_) {
    if (!names.contains(watched)) ::inotify_rm_watch(inotify_, watched);
  }
  names_ = std::move(names);
}

bool FileWatch::wait(std::chrono::milliseconds longest) {
  pollfd both[] = {{inotify_, POLLIN, 0}, {event_, POLLIN, 0}};
  if (::poll(both, 2, static_cast<int>(longest.count())) <= 0) return false;
  bool changed = false;
  uint64_t woken = 0;
  [[maybe_unused]] const ssize_t none = ::read(event_, &woken, sizeof woken);
  alignas(inotify_event) char buffer[4096];
  for (ssize_t size = 0; (size = ::read(inotify_, buffer, sizeof buffer)) > 0;) {
    for (ssize_t at = 0; at < size;) {
      inotify_event event{};
      std::memcpy(&event, buffer + at, sizeof event);
      const char* name = buffer + at + offsetof(inotify_event, name);
      const auto folder = names_.find(event.wd);
      const bool known = folder != names_.end() && event.len > 0 && folder->second.contains(name);
      if (known || (event.mask & IN_Q_OVERFLOW)) changed = true;
      at += static_cast<ssize_t>(sizeof event + event.len);
    }
  }
  return changed;
}

void FileWatch::wake() {
  const uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(event_, &one, sizeof one);
}

}  // namespace pelage
