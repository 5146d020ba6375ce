// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace pelage {

/// Receives how far a long job is, and says whether to go on. Thread safety: every member may be called from
/// any thread; `advance` is called often and must be cheap.
class Progress {
 public:
  virtual ~Progress() = default;
  /// A stage begins: "grow", "build", "render frame 3". Stages do not nest.
  virtual void begin(std::string_view stage, double total) = 0;
  virtual void advance(double amount) = 0;
  /// The whole of the current stage is now thought to be this much, in place of what begin() said.
  virtual void expect(double /*total*/) {}
  virtual void end() = 0;
  /// A line for the user, between or within stages; where nobody looks, nothing happens.
  virtual void note(std::string_view /*line*/) {}
  /// The same for what went wrong and did not stop the run.
  virtual void warn(std::string_view /*line*/) {}
  /// True once the user has asked to stop (Ctrl-C): loops finish what they hold and leave.
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
