// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <string_view>

#include "base/progress.h"

namespace pelage {

/// Asks to stop once rendering has reported `patience` camera samples.
class Impatient final : public Progress {
 public:
  explicit Impatient(double patience) : patience_(patience) {}
  void begin(std::string_view stage, double) override { rendering_ = stage == "render"; }
  void advance(double amount) override {
    if (rendering_) done_ = done_ + amount;
  }
  void end() override {}
  bool cancelled() const override { return done_ >= patience_; }

 private:
  double patience_;
  std::atomic<bool> rendering_{false};
  std::atomic<double> done_{0};
};

}  // namespace pelage
