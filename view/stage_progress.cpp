// SPDX-License-Identifier: Apache-2.0
#include "view/stage_progress.h"

#include <algorithm>
#include <utility>

namespace pelage {
namespace {

constexpr double kStep = 0.005;  // the state shows progress in steps of this fraction
constexpr size_t kMaxWarnings = 20;

}  // namespace

StageProgress::StageProgress(ViewState& state, const MemoryLedger& ledger, std::function<bool()> must_end)
    : state_(state), ledger_(ledger), must_end_(std::move(must_end)) {}

double StageProgress::Stage::fraction() const { return total > 0 ? std::min(done / total, 1.0) : 0; }

void StageProgress::reset() {
  const std::lock_guard lock(mutex_);
  stages_.clear();
}

void StageProgress::begin(std::string_view stage, double total) {
  const std::lock_guard lock(mutex_);
  stages_.push_back({std::string(stage), total, 0});
  show();
}

void StageProgress::advance(double amount) {
  const std::lock_guard lock(mutex_);
  if (stages_.empty()) return;
  Stage& stage = stages_.back();
  stage.done += amount;
  if (stage.fraction() - shown_ > kStep) show();
}

void StageProgress::expect(double total) {
  const std::lock_guard lock(mutex_);
  if (!stages_.empty()) stages_.back().total = total;
}

void StageProgress::end() {
  const std::lock_guard lock(mutex_);
  if (!stages_.empty()) stages_.pop_back();
  show();
}

void StageProgress::warn(std::string_view line) {
  state_.update([&](ViewStatus& status) {
    status.warnings.emplace_back(line);
    if (status.warnings.size() > kMaxWarnings) status.warnings.erase(status.warnings.begin());
  });
}

void StageProgress::show() {
  const Stage stage = stages_.empty() ? Stage{} : stages_.back();
  shown_ = stage.fraction();
  state_.update([&](ViewStatus& status) {
    status.stage = stage.name;
    status.progress = shown_;
    status.memory_bytes = ledger_.budgeted();
  });
}

}  // namespace pelage
