// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "cli/options.h"
#include "cli/time_left.h"

namespace pelage {

/// Destination and appearance of progress.
struct ProgressTarget {
  std::function<void(std::string_view)> write;  ///< called under a lock, with complete lines or redraws
  std::function<double()> seconds;              ///< a monotonic clock
  int columns = 80;                             ///< of the terminal, for the bar
  bool color = false;
};

/// Shows progress as a bar, as lines or as JSON lines. The first thread that passes the next step draws the
/// progress; other threads never wait for this thread. A nested stage is shown instead of the outer one until
/// it ends.
///
/// Lines are for logs. A stage gets a line after ten seconds, one every half minute afterwards, and one at
/// its end if it took a second or more.
class ProgressDisplay final : public Progress {
 public:
  /// Writes to standard error. kAuto becomes a bar on a terminal and lines elsewhere; colour follows NO_COLOR
  /// and TERM. cancelled() calls `cancelled`, which must be cheap and thread safe.
  ProgressDisplay(ProgressStyle style, std::function<bool()> cancelled);
  /// For tests and other targets; `style` is not kAuto.
  ProgressDisplay(ProgressStyle style, ProgressTarget target, std::function<bool()> cancelled);
  ~ProgressDisplay() override;

  /// Announces the current frame, number `place` of `count`, counted from 1. Not shown for a single frame.
  void frame(int number, size_t place, size_t count);

  void begin(std::string_view stage, double total) override;
  void advance(double amount) override;
  void expect(double total) override;
  void end() override;
  bool cancelled() const override { return cancelled_(); }

  /// Does not interrupt the bar. Not shown when quiet.
  void note(std::string_view line) override;
  /// The same for problems that do not stop the run; also shown when quiet.
  void warn(std::string_view line) override;

 private:
  struct Stage {
    std::string name;
    double began_s = 0, done = 0, total = 1;
    double due_s = 0;  ///< when the next line is due
    int shown_percent = -1;
    TimeLeft left;
  };
  void show(std::string_view kind, std::string_view line);
  void draw(bool last);
  void draw_line(Stage& stage, bool last, double now_s);
  void draw_json(Stage& stage, bool last, double now_s);
  std::string bar_line(const Stage& stage, double now_s) const;
  std::string title(const Stage& stage) const;
  void set_next_step(double done);

  ProgressStyle style_;
  ProgressTarget target_;
  std::function<bool()> cancelled_;

  std::atomic<double> done_{0};  // of the innermost stage
  std::atomic<double> next_step_{0};

  std::mutex mutex_;  // guards the following
  std::vector<Stage> stages_;
  struct Frame {
    int number = 0;
    size_t place = 0, count = 0;
  };
  std::optional<Frame> frame_;
  double drawn_s_ = 0;
  bool line_open_ = false;  // the cursor is at the end of a bar
};

/// "0:07", "12:40", "1:02:03".
std::string duration_text(double seconds);

}  // namespace pelage
