// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "base/ledger.h"
#include "base/progress.h"
#include "view/view_state.h"

namespace pelage {

/// Shows on a ViewState which stage the work is in, how far the stage is, and how much memory is in use. Also
/// shows the last few warnings. Thread safety: all members may be called from any thread.
class StageProgress final : public Progress {
 public:
  /// `must_end`: whether the work is cancelled; called from any thread. The state and the ledger must outlive
  /// this object.
  StageProgress(ViewState& state, const MemoryLedger& ledger, std::function<bool()> must_end);

  /// Forgets all stages, for work that begins anew.
  void reset();

  void begin(std::string_view stage, double total) override;
  void advance(double amount) override;
  void expect(double total) override;
  void end() override;
  void warn(std::string_view line) override;
  bool cancelled() const override { return must_end_(); }

 private:
  struct Stage {
    std::string name;
    double total = 0, done = 0;
    double fraction() const;
  };
  void show();

  ViewState& state_;
  const MemoryLedger& ledger_;
  const std::function<bool()> must_end_;
  std::mutex mutex_;
  std::vector<Stage> stages_;  // each is a part of the one before
  double shown_ = 0;           // fraction of the last stage on the state
};

}  // namespace pelage
