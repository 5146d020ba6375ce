// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <mutex>
#include <string>

#include <sched.h>
#include <tbb/task_arena.h>
#ifdef PELAGE_STD_THREADS
#include <thread>
#include <vector>
#else
#include <tbb/parallel_for.h>
#endif

namespace pelage {

namespace {

// Quota of the control group in processors, rounded up; 0 when there is none.
int cgroup_processors() {
  std::ifstream v2("/sys/fs/cgroup/cpu.max");
  std::string quota;
  double period = 0;
  if (v2 >> quota >> period && quota != "max" && period > 0) {
    return static_cast<int>(std::ceil(std::atof(quota.c_str()) / period));
  }
  return 0;
}

// Hands out ranges in order and keeps the first error of a loop.
class RangeDealer {
 public:
  RangeDealer(size_t count, size_t grain) : count_(count), grain_(std::max<size_t>(1, grain)) {}

  void work(int worker, const std::function<void(WorkRange)>& body) {
    try {
      while (!stopped_.load(std::memory_order_relaxed)) {
        const size_t begin = next_.fetch_add(grain_, std::memory_order_relaxed);
        if (begin >= count_) return;
        body({begin, std::min(begin + grain_, count_), worker});
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      stopped_.store(true, std::memory_order_relaxed);
    }
  }

  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  const size_t count_;
  const size_t grain_;
  std::atomic<size_t> next_{0};
  std::atomic<bool> stopped_{false};
  std::mutex mutex_;  // guards error_
  std::exception_ptr error_;
};

}  // namespace

int available_processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  int count = ::sched_getaffinity(0, sizeof(set), &set) == 0 ? CPU_COUNT(&set) : 1;
  if (const int quota = cgroup_processors()) count = std::min(count, quota);
  return std::max(1, count);
}

#ifdef PELAGE_STD_THREADS

struct Workers::Team {
  explicit Team(int count) : threads(count) {}

  void run(RangeDealer& dealer, const std::function<void(WorkRange)>& body) {
    const std::lock_guard lock(one_loop);
    std::vector<std::thread> others;
    for (int i = 1; i < threads; ++i) others.emplace_back([&, i] { dealer.work(i, body); });
    dealer.work(0, body);
    for (std::thread& thread : others) thread.join();
  }

  int threads;
  std::mutex one_loop;
};

#else

struct Workers::Team {
  explicit Team(int count) : threads(count), arena(count) {}

  // With two loops, a thread that waits for one of them could run a part of the other, and TBB may add a
  // thread to the arena. Both would use the scratch memory of a worker that is busy or does not exist.
  void run(RangeDealer& dealer, const std::function<void(WorkRange)>& body) {
    const std::lock_guard lock(one_loop);
    arena.execute([&] {
      tbb::parallel_for(
          0, threads, [&](int) { dealer.work(tbb::this_task_arena::current_thread_index(), body); },
          tbb::simple_partitioner());
    });
  }

  int threads;
  std::mutex one_loop;
  tbb::task_arena arena;
};

#endif

Workers::Workers(int threads)
    : Workers(std::make_unique<Team>(threads > 0 ? threads : available_processors())) {}
Workers::Workers(std::unique_ptr<Team> team) : team_(std::move(team)) {}
Workers Workers::alone() { return Workers(std::unique_ptr<Team>()); }
Workers::~Workers() = default;
Workers::Workers(Workers&&) noexcept = default;
Workers& Workers::operator=(Workers&&) noexcept = default;

int Workers::thread_count() const { return team_ ? team_->threads : 1; }

void Workers::for_each(size_t count, size_t grain, const std::function<void(WorkRange)>& body) const {
  RangeDealer dealer(count, grain);
  if (team_) {
    team_->run(dealer, body);
  } else {
    dealer.work(0, body);
  }
  dealer.rethrow();
}

#ifdef PELAGE_STD_THREADS

// TBB passes the memory of an ended arena to the next one in ways that the thread sanitizer cannot see, and
// clears it with a function that it can see. Therefore arenas are created and destroyed one at a time here.
// The tasks inside the arenas still run in any order.
void Workers::run_library(const std::function<void()>& body) const {
  const auto turn = team_ ? std::unique_lock(team_->one_loop) : std::unique_lock<std::mutex>();
  static std::mutex mutex;
  struct SerialArena {
    SerialArena() {
      const std::lock_guard lock(mutex);
      arena.initialize(1);
    }
    ~SerialArena() {
      const std::lock_guard lock(mutex);
      arena.terminate();
    }
    tbb::task_arena arena;
  };
  SerialArena().arena.execute(body);
}

#else

void Workers::run_library(const std::function<void()>& body) const {
  if (team_) {
    const std::lock_guard lock(team_->one_loop);
    return team_->arena.execute(body);
  }
  tbb::task_arena alone(1);
  alone.execute(body);
}

#endif

}  // namespace pelage
