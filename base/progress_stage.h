// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "base/progress.h"

namespace pelage {

/// A stage of a Progress that ends with its scope, also when something is thrown.
class ProgressStage {
 public:
  ProgressStage(Progress& progress, std::string_view name, double total) : progress_(progress) {
    progress_.begin(name, total);
  }
  ~ProgressStage() { progress_.end(); }
  ProgressStage(const ProgressStage&) = delete;
  ProgressStage& operator=(const ProgressStage&) = delete;

 private:
  Progress& progress_;
};

}  // namespace pelage
