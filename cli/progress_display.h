// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "cli/run_options.h"
#include "cli/time_left.h"

namespace pelage {

/// Where and how progress is shown.
struct ProgressTarget {
  std::function<void(std::string_view)> write;  ///< writes complete lines or redraws; called under a lock
  std::function<double()> seconds;              ///< reads a monotonic clock
  int columns = 80;                             ///< width of the terminal, for the bar
  bool color = false;
  /// Writes the lines that only the queues of farms read; called under a lock.
  std::function<void(std::string_view)> percent = {};
};

/// Shows progress as a bar, as lines or as JSON lines. The display is due for an update at every thousandth
/// of a stage. The thread that first reaches this progress draws; other threads do not wait for it. While a
/// nested stage runs, it is shown instead of the outer stage.
///
/// Lines are meant for logs. A stage gets its first line after ten seconds, and another one every half
/// minute. It also gets a line at its end if it took a second or more.
///
/// The queues of render farms get one percentage for the whole run: that of the stages "render" of all
/// frames.
class ProgressDisplay final : public Progress {
 public:
  /// Writes to standard error. kAuto becomes a bar on a terminal, and lines elsewhere. Colours follow the
  /// environment variables NO_COLOR and TERM. `cancelled` implements cancelled(); it must be cheap and
  /// thread-safe.
  ProgressDisplay(ProgressStyle style, std::function<bool()> cancelled);
  /// Writes to another target, for example in tests. `style` must not be kAuto.
  ProgressDisplay(ProgressStyle style, ProgressTarget target, std::function<bool()> cancelled);
  ~ProgressDisplay() override;

  /// Announces the current frame: the frame number is `number`, and it is frame `place` of `count`, counted
  /// from 1. Shows nothing if `count` is 1.
  void frame(int number, size_t place, size_t count);

  void begin(std::string_view stage, double total) override;
  void advance(double amount) override;
  void expect(double total) override;
  void end() override;
  bool cancelled() const override { return cancelled_(); }

  /// Shows a line of text without damaging the bar. Shows nothing with kQuiet.
  void note(std::string_view line) override;
  /// Shows a line about a problem that does not stop the run, in the same way. Shows it even with kQuiet.
  void warn(std::string_view line) override;

 private:
  struct Stage {
    std::string name;
    double began_s = 0, done = 0, total = 1;
    double due_s = 0;  ///< time of the next line
    int shown_percent = -1;
    TimeLeft left;
  };
  void show(std::string_view kind, std::string_view line);
  void draw(bool last);
  void draw_line(Stage& stage, bool last, double now_s);
  void draw_json(Stage& stage, bool last, double now_s);
  void draw_percent(const Stage& stage);
  std::string bar_line(const Stage& stage, double now_s) const;
  std::string title(const Stage& stage) const;
  void set_next_step(double done);

  ProgressStyle style_;
  ProgressTarget target_;
  std::function<bool()> cancelled_;

  std::atomic<double> done_{0};  // progress of the innermost stage
  std::atomic<double> next_step_{0};

  std::mutex mutex_;  // guards the members below
  std::vector<Stage> stages_;
  struct Frame {
    int number = 0;
    size_t place = 0, count = 0;
  };
  std::optional<Frame> frame_;
  int run_percent_ = -1;  // last line of draw_percent()
  double drawn_s_ = 0;
  bool line_open_ = false;  // the cursor is at the end of a bar, not at the start of a line
};

/// Returns a duration as text: "0:07", "12:40", "1:02:03".
std::string duration_text(double seconds);

}  // namespace pelage
