// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace pelage {

/// A half-open range of indices, and the worker (0 .. thread_count-1) that processes it.
struct WorkRange {
  size_t begin = 0;
  size_t end = 0;
  int worker = 0;
};

/// A pool of threads for parallel loops. Thread safety: one loop at a time per pool.
///
/// The first exception of a loop stops it from handing out further ranges; for_each rethrows it once every
/// worker has stopped. Results must not depend on `worker` or on the order of ranges (law 1); `worker` is for
/// scratch memory only. In the thread-sanitizer build the pool uses std::thread, because TBB's own threads
/// are not instrumented.
class Workers {
 public:
  /// `threads` = 0: as many as the process may use (respects affinity and cgroup limits).
  explicit Workers(int threads = 0);
  ~Workers();
  Workers(Workers&&) noexcept;
  Workers& operator=(Workers&&) noexcept;

  /// A pool that consists of the calling thread alone. Loops run in place, so this pool may be used inside a
  /// loop of another pool, on many threads at once. run_library() also stays on the calling thread. While
  /// this thread waits, it runs no task of another loop, because such a task could need a result that this
  /// thread has not finished yet.
  static Workers alone();

  int thread_count() const;

  /// Calls `body` for disjoint ranges of at most `grain` indices that together cover 0 .. count-1.
  void for_each(size_t count, size_t grain, const std::function<void(WorkRange)>& body) const;

  /// Calls `body` once. Libraries that `body` calls and that use TBB run only on the threads of this pool; in
  /// the thread-sanitizer build, only on the calling thread.
  void run_library(const std::function<void()>& body) const;

 private:
  struct Team;
  explicit Workers(std::unique_ptr<Team> team);
  std::unique_ptr<Team> team_;  // null: only the calling thread
};

/// Processors that this process may use: the smaller of affinity mask and cgroup quota.
int available_processors();

}  // namespace pelage
