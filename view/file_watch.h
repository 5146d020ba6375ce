// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace pelage {

/// Waits for changes of files with inotify. Watches the folders of the files, because many editors replace a
/// file by renaming another one, which ends a watch of the file itself. Thread safety: wake() may be called
/// from any thread, the other members from one thread only.
class FileWatch {
 public:
  /// Throws Error (kFailed) when the system has no more inotify instances.
  FileWatch();
  ~FileWatch();
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;

  /// Replaces the files to watch. A file need not exist. A folder that does not exist or that cannot be
  /// watched is left out. Also watches the target of a symbolic link.
  void watch(const std::vector<std::filesystem::path>& files);
  /// Waits until one of the files is written, created, replaced or removed, until wake() is called or until
  /// the time is over. Returns whether a file changed. Removes all changes that are waiting.
  bool wait(std::chrono::milliseconds longest);
  /// Ends the wait() that is under way, or else the next one.
  void wake();

 private:
  int inotify_ = -1, event_ = -1;
  std::map<int, std::set<std::string>> names_;  // names of the watched files, by folder
};

}  // namespace pelage
