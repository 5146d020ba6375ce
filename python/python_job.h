// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "base/progress.h"

namespace pelage {

/// Progress of one call from Python. Worker threads only store their reports. The thread that called
/// from Python passes reports to the callback progress(stage, fraction), and warnings to the module
/// `warnings`.
///
/// Thread safety: members of Progress, stop() and fail() may be called from any thread.
class PythonProgress final : public Progress {
 public:
  /// `callback`: None or a callable.
  explicit PythonProgress(pybind11::object callback) : callback_(std::move(callback)) {}

  void begin(std::string_view stage, double total) override;
  void advance(double amount) override;
  void expect(double total) override { total_ = total; }
  void end() override {}
  void warn(std::string_view line) override;
  bool cancelled() const override { return stopped_; }

  void stop() { stopped_ = true; }
  /// Stops the work; run_job() throws `failure` in place of its result.
  void fail(std::exception_ptr failure);
  void throw_failure() const;

  /// Looks for signals and calls the callback if there is news. An exception stops the work. Call with the
  /// interpreter's lock, on the thread that Python called.
  void report();
  /// Issues the warnings of the work. Throws if the user has made warnings errors.
  void issue_warnings();

 private:
  const pybind11::object callback_;
  std::atomic<bool> stopped_{false};
  std::atomic<double> done_{0}, total_{1};
  std::mutex mutex_;  // guards the next three
  std::string stage_;
  std::vector<std::string> warnings_;
  std::exception_ptr failure_;
  std::string told_stage_;  // by report()
  double told_fraction_ = -1;
};

/// Runs `work` on a thread of its own without the interpreter's lock, and meanwhile reports on this thread
/// every 50 ms, so that Ctrl-C and callbacks work however long a step takes. Throws what the work throws, or
/// the exception of Python that stopped it.
void run_job(PythonProgress& progress, const std::function<void()>& work);

}  // namespace pelage
