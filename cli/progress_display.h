// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <string>

#include "base/progress.h"
#include "cli/options.h"

namespace pelage {

/// Where progress goes and how it looks there.
struct ProgressTarget {
  std::function<void(std::string_view)> write;  ///< called under a lock, with whole lines or redraws
  int columns = 80;                             ///< of the terminal, for the bar
  bool color = false;
};

/// Shows progress as a bar, as lines or as JSON lines. Drawing is left to whichever thread passes the next
/// step first; others never wait for it.
class ProgressDisplay final : public Progress {
 public:
  /// On standard error. kAuto becomes a bar on a terminal and lines elsewhere; colour follows NO_COLOR and
  /// TERM. `cancelled` is asked by cancelled() and must be cheap and thread safe.
  ProgressDisplay(ProgressStyle style, std::function<bool()> cancelled);
  /// For tests and other targets; `style` is not kAuto.
  ProgressDisplay(ProgressStyle style, ProgressTarget target, std::function<bool()> cancelled);
  ~ProgressDisplay() override;

  void begin(std::string_view stage, double total) override;
  void advance(double amount) override;
  void expect(double total) override;
  void end() override;
  bool cancelled() const override { return cancelled_(); }

  /// Does not tear the bar. Not shown when quiet.
  void note(std::string_view line) override;
  /// The same for what went wrong and did not stop the run: shown when quiet, too.
  void warn(std::string_view line) override;

 private:
  using Clock = std::chrono::steady_clock;
  void show(std::string_view kind, std::string_view line);
  void draw(double done, bool last);
  std::string bar_line(double fraction, double elapsed) const;
  void set_next_step(double done);

  ProgressStyle style_;
  ProgressTarget target_;
  std::function<bool()> cancelled_;

  std::atomic<double> done_{0};
  std::atomic<double> next_step_{0};
  double total_ = 1;  // changed and read under mutex_

  std::mutex mutex_;  // guards what follows
  std::string stage_;
  Clock::time_point began_;
  Clock::time_point drawn_;
  bool in_stage_ = false;
  bool line_open_ = false;  // the cursor stands behind a bar
  int shown_percent_ = -1;
};

/// "0:07", "12:40", "1:02:03".
std::string duration_text(double seconds);

}  // namespace pelage
