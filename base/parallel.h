// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace pelage {

/// A half-open range of indices, and which of the workers (0 .. thread_count-1) holds it.
struct WorkRange {
  size_t begin = 0;
  size_t end = 0;
  int worker = 0;
};

/// A team of threads of our own for parallel loops. Thread safety: one loop at a time per team.
///
/// The first exception of a loop stops the handing out of further ranges and is rethrown by for_each once
/// every worker has stopped. What a loop computes must not depend on `worker` or on the order of ranges (law
/// 1); `worker` is there for scratch memory only. In the thread-sanitizer build the team is made of
/// std::thread, because TBB's own threads are not instrumented.
class Workers {
 public:
  /// `threads` = 0: as many as the process may use (affinity and cgroup limits respected).
  explicit Workers(int threads = 0);
  ~Workers();
  Workers(Workers&&) noexcept;
  Workers& operator=(Workers&&) noexcept;

  /// The calling thread alone: loops run in place, so that it works inside a loop of another team, on many
  /// threads at once. What is lent to a library keeps to that thread too: while it waits, it does not take
  /// on work of anybody else, which could need what this thread is about to make.
  static Workers alone();

  int thread_count() const;

  /// Calls `body` for ranges of at most `grain` indices that together cover 0 .. count-1 once each.
  void for_each(size_t count, size_t grain, const std::function<void(WorkRange)>& body) const;

  /// Calls `body` once, where a library that is parallel through TBB by itself has this team's threads and no
  /// others; in the thread-sanitizer build it has only the calling one.
  void run_library(const std::function<void()>& body) const;

 private:
  struct Team;
  explicit Workers(std::unique_ptr<Team> team);
  std::unique_ptr<Team> team_;  // null: the calling thread alone
};

/// Processors this process may run on: the smaller of affinity mask and cgroup quota.
int available_processors();

}  // namespace pelage
