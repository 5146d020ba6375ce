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

/// Where progress goes and how it looks there.
struct ProgressTarget {
  std::function<void(std::string_view)> write;  ///< called under a lock, with whole lines or redraws
  std::function<double()> seconds;              ///< a clock that never goes back
  int columns = 80;                             ///< of the terminal, for the bar
  bool color = false;
};

/// Shows progress as a bar, as lines or as JSON lines. Drawing is left to whichever thread passes the next
/// step first; others never wait for it. A stage within a stage is shown in its place until it ends.
///
/// Lines are for logs: one when a stage has gone on for ten seconds, one every half minute from then on, and
/// one at the end of each stage that took a second or more.
class ProgressDisplay final : public Progress {
 public:
  /// On standard error. kAuto becomes a bar on a terminal and lines elsewhere; colour follows NO_COLOR and
  /// TERM. `cancelled` is asked by cancelled() and must be cheap and thread safe.
  ProgressDisplay(ProgressStyle style, std::function<bool()> cancelled);
  /// For tests and other targets; `style` is not kAuto.
  ProgressDisplay(ProgressStyle style, ProgressTarget target, std::function<bool()> cancelled);
  ~ProgressDisplay() override;

  /// What follows is about this frame, the `place`-th of `count`, counted from 1. Not shown for one frame.
  void frame(int number, size_t place, size_t count);

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

  std::mutex mutex_;  // guards what follows
  std::vector<Stage> stages_;
  struct Frame {
    int number = 0;
    size_t place = 0, count = 0;
  };
  std::optional<Frame> frame_;
  double drawn_s_ = 0;
  bool line_open_ = false;  // the cursor stands behind a bar
};

/// "0:07", "12:40", "1:02:03".
std::string duration_text(double seconds);

}  // namespace pelage
