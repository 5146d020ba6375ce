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

/// A pool of threads for parallel loops. Thread safety: all members may be called from any thread. A pool
/// runs one loop at a time: other loops wait until it ends. A loop must not begin another loop of its own
/// pool.
///
/// After the first exception, a loop starts no further ranges. for_each() rethrows this exception once all
/// workers have stopped. Results must not depend on the order of ranges, nor on `worker`, which may only
/// select scratch memory (law 1). Loops that several threads start take turns, so a loop must not start a
/// loop of its own pool, which would wait for it. In the thread-sanitizer build, the pool uses std::thread,
/// because the threads of TBB are not instrumented.
class Workers {
 public:
  /// `threads`: number of threads; 0 means available_processors().
  explicit Workers(int threads = 0);
  ~Workers();
  Workers(Workers&&) noexcept;
  Workers& operator=(Workers&&) noexcept;

  /// Returns a pool that consists of the calling thread alone. Its loops and run_library() run on the thread
  /// that calls them, so they may be called inside a loop of another pool, on many threads at once. In
  /// run_library(), the calling thread never runs a task of another loop while it waits, because such a task
  /// could need a result that this thread has not finished yet.
  static Workers alone();

  int thread_count() const;

  /// Calls `body` for disjoint ranges of up to `grain` indices, which together cover 0 .. count-1.
  void for_each(size_t count, size_t grain, const std::function<void(WorkRange)>& body) const;

  /// Calls `body` once. If `body` calls a library that uses TBB, this library runs only on the threads of
  /// this pool. Library calls take turns with loops, so a loop must not make one on its own pool. In the
  /// thread-sanitizer build, the library runs only on the calling thread.
  void run_library(const std::function<void()>& body) const;

 private:
  struct Team;
  explicit Workers(std::unique_ptr<Team> team);
  std::unique_ptr<Team> team_;  // null: only the calling thread
};

/// Returns the number of processors that this process may use, at least 1: the number in its affinity mask or
/// its cgroup quota (rounded up), whichever is smaller.
int available_processors();

}  // namespace pelage
