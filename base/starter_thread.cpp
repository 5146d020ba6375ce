// SPDX-License-Identifier: Apache-2.0
#include "base/starter_thread.h"

#include <csignal>

namespace pelage {

StarterThread::StarterThread() {
  sigset_t all, before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);  // inherited by the new thread
  thread_ = std::thread([this] { loop(); });
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

StarterThread::~StarterThread() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void StarterThread::run(const std::function<void()>& task) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !task_; });  // another caller's
  task_ = &task;
  changed_.notify_all();
  changed_.wait(lock, [&] { return task_ != &task; });
}

void StarterThread::loop() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return task_ || ends_; });
    if (!task_) return;
    (*task_)();
    task_ = nullptr;
    changed_.notify_all();
  }
}

}  // namespace pelage
