// SPDX-License-Identifier: Apache-2.0
#include "python/python_job.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace py = pybind11;

namespace pelage {

void PythonProgress::begin(std::string_view stage, double total) {
  const std::lock_guard lock(mutex_);
  stage_ = stage;
  done_ = 0;
  total_ = total;
}

void PythonProgress::advance(double amount) {
  double done = done_;
  while (!done_.compare_exchange_weak(done, done + amount)) {
  }
}

void PythonProgress::warn(std::string_view line) {
  const std::lock_guard lock(mutex_);
  warnings_.emplace_back(line);
}

void PythonProgress::fail(std::exception_ptr failure) {
  const std::lock_guard lock(mutex_);
  if (!failure_) failure_ = std::move(failure);
  stopped_ = true;
}

void PythonProgress::throw_failure() const {
  if (failure_) std::rethrow_exception(failure_);
}

void PythonProgress::report() {
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (callback_.is_none()) return;
    std::string stage;
    {
      const std::lock_guard lock(mutex_);
      stage = stage_;
    }
    const double total = total_;
    const double fraction = total > 0 ? std::clamp(done_ / total, 0.0, 1.0) : 1;
    if (stage.empty() || (stage == told_stage_ && fraction == told_fraction_)) return;
    told_stage_ = stage;
    told_fraction_ = fraction;
    callback_(stage, fraction);
  } catch (py::error_already_set&) {
    fail(std::current_exception());
  }
}

void PythonProgress::issue_warnings() {
  std::vector<std::string> lines;
  {
    const std::lock_guard lock(mutex_);
    lines.swap(warnings_);
  }
  if (lines.empty()) return;
  const py::object category = py::module_::import("pelage._errors").attr("PelageWarning");
  for (const std::string& line : lines) {
    if (PyErr_WarnEx(category.ptr(), line.c_str(), 2) != 0) throw py::error_already_set();
  }
}

void run_job(PythonProgress& progress, const std::function<void()>& work) {
  std::exception_ptr failure;
  {
    const py::gil_scoped_release release;
    std::mutex mutex;
    std::condition_variable ended;
    bool done = false;
    std::thread worker([&] {
      try {
        work();
      } catch (...) {
        failure = std::current_exception();
      }
      const std::lock_guard lock(mutex);
      done = true;
      ended.notify_one();
    });
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, std::chrono::milliseconds(50), [&] { return done; })) {
      lock.unlock();
      {
        const py::gil_scoped_acquire acquire;
        progress.report();
      }
      lock.lock();
    }
    lock.unlock();
    worker.join();
  }
  progress.report();
  progress.throw_failure();
  progress.issue_warnings();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace pelage
