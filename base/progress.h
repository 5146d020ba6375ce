// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace pelage {

/// Receives the progress of a long job, and tells the job whether to stop. advance() is called often, so it
/// must be cheap. Thread safety: implementations must allow calls of every member from any thread.
class Progress {
 public:
  virtual ~Progress() = default;
  /// Called when a stage begins. `stage`: its name, such as "grow", "build" or "render frame 3". `total`:
  /// amount of work in the stage, in any unit. Stages do not nest.
  virtual void begin(std::string_view stage, double total) = 0;
  /// Called when `amount` more of the stage's total is done.
  virtual void advance(double amount) = 0;
  /// Called with a better estimate of the total of the current stage than the one passed to begin().
  virtual void expect(double /*total*/) {}
  /// Called when the stage ends.
  virtual void end() = 0;
  /// Receives a line of text for the user, between or within stages. Does nothing by default.
  virtual void note(std::string_view /*line*/) {}
  /// Receives a line of text about a problem that does not stop the run. Does nothing by default.
  virtual void warn(std::string_view /*line*/) {}
  /// Returns true once the user has asked to stop (Ctrl-C). Loops then finish their current item and return.
  virtual bool cancelled() const = 0;
};

/// Shows nothing and never stops.
class NoProgress : public Progress {
 public:
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  bool cancelled() const override { return false; }
};

/// Begins a stage of a Progress in its constructor and ends the stage in its destructor, also after an
/// exception. If `worth_showing` is false, for example because the stage is short, reports nothing.
class ProgressStage {
 public:
  ProgressStage(Progress& progress, std::string_view name, double total, bool worth_showing = true)
      : progress_(progress), shown_(worth_showing) {
    if (shown_) progress_.begin(name, total);
  }
  ~ProgressStage() {
    if (shown_) progress_.end();
  }
  ProgressStage(const ProgressStage&) = delete;
  ProgressStage& operator=(const ProgressStage&) = delete;

  void advance(double amount) const {
    if (shown_) progress_.advance(amount);
  }

 private:
  Progress& progress_;
  const bool shown_;
};

}  // namespace pelage
