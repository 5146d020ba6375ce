// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/temporary_folder.h"

namespace pelage {

/// The reply of a program: a RIB file. Removed from the disk when nobody uses it any more.
class RibReply {
 public:
  /// `folder`: removed after the last reply in it.
  RibReply(std::filesystem::path path, std::shared_ptr<const TemporaryFolder> folder)
      : folder_(std::move(folder)), path_(std::move(path)) {}
  ~RibReply();
  RibReply(const RibReply&) = delete;
  RibReply& operator=(const RibReply&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  const std::shared_ptr<const TemporaryFolder> folder_;
  const std::filesystem::path path_;
};

struct RibProgramLimits {
  double reply_s = 600;                   ///< time for one reply
  size_t reply_bytes = size_t(16) << 30;  ///< size of one reply
  size_t kept_bytes = size_t(4) << 30;    ///< replies that nobody uses are kept up to this size together
  size_t requests = 1'000'000;            ///< count of all requests
  size_t all_bytes = size_t(256) << 30;   ///< size of all replies together, also of those no longer kept
};

/// Runs the programs of procedurals of kind RunProgram [RISPEC 3.2, RiProcRunProgram]. A process answers all
/// requests with the same command: it reads lines "detail arguments", and answers each with RIB as text and a
/// byte 255. A request is sent once; its reply is kept in a temporary file, because the same procedural is
/// read for its materials, for its boxes and for its strands. Programs are ended with this object.
///
/// Thread safety: members may be called from any thread; a program answers one request at a time.
class RibPrograms {
 public:
  explicit RibPrograms(const RibProgramLimits& limits = {});
  ~RibPrograms();
  RibPrograms(const RibPrograms&) = delete;
  RibPrograms& operator=(const RibPrograms&) = delete;

  /// Returns the reply to a request. `command`: a program and its arguments, divided at blanks. The program
  /// is searched in `folders` and then on PATH. `check_stop` may be empty; it is called often and may throw.
  /// Throws Error (kInput) if there is no such program, if it ends early, is too slow, or answers too much,
  /// or if there were too many requests.
  std::shared_ptr<const RibReply> ask(const std::string& command,
                                      const std::vector<std::filesystem::path>& folders,
                                      const std::string& request, const std::function<void()>& check_stop);

 private:
  class Program;
  Program& program(const std::string& command, const std::vector<std::filesystem::path>& folders);
  void keep(std::shared_ptr<const RibReply> reply, size_t bytes);

  const RibProgramLimits limits_;
  std::mutex mutex_;  // guards the following
  std::shared_ptr<const TemporaryFolder> folder_;
  std::map<std::string, std::unique_ptr<Program>> programs_;                              // by command
  std::map<std::pair<std::string, std::string>, std::weak_ptr<const RibReply>> replies_;  // command, request
  std::deque<std::pair<std::shared_ptr<const RibReply>, size_t>> kept_;                   // with their sizes
  size_t kept_bytes_ = 0, count_ = 0, all_bytes_ = 0;
};

}  // namespace pelage
