// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace pelage {

/// A thread that starts processes for other threads. With PR_SET_PDEATHSIG, the system ends a process when
/// the thread that started it ends: here, when this object is destroyed or the whole program dies. Receives
/// no signals. Thread safety: run() may be called from any thread.
class StarterThread {
 public:
  /// Throws std::system_error when the system has no room for another thread.
  StarterThread();
  ~StarterThread();
  StarterThread(const StarterThread&) = delete;
  StarterThread& operator=(const StarterThread&) = delete;

  /// Calls `task` on the thread, and waits for its end. `task` must not throw.
  void run(const std::function<void()>& task);

 private:
  void loop();

  std::mutex mutex_;
  std::condition_variable changed_;
  const std::function<void()>* task_ = nullptr;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace pelage
