// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "base/progress.h"

namespace pelage {

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
