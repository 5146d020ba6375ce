// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace pelage {

/// Receives the progress of a long job, and can request a stop. Thread safety: every member may be called
/// from any thread; `advance` is called often and must be cheap.
class Progress {
 public:
  virtual ~Progress() = default;
  /// A stage begins: "grow", "build", "render frame 3". Stages do not nest.
  virtual void begin(std::string_view stage, double total) = 0;
  virtual void advance(double amount) = 0;
  /// Replaces the total that begin() gave for the current stage by a better estimate.
  virtual void expect(double /*total*/) {}
  virtual void end() = 0;
  /// A line for the user, between or within stages; does nothing by default.
  virtual void note(std::string_view /*line*/) {}
  /// The same for problems that do not stop the run.
  virtual void warn(std::string_view /*line*/) {}
  /// True once the user has asked to stop (Ctrl-C): loops then finish the current item and return.
  virtual bool cancelled() const = 0;
};

/// Shows nothing and never stops.
class NoProgress final : public Progress {
 public:
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  bool cancelled() const override { return false; }
};

}  // namespace pelage
