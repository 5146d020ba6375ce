// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "base/progress.h"

namespace pelage {

/// A Progress that shows nothing. stop() cancels the work from another thread.
class StopSwitch : public NoProgress {
 public:
  void stop() { stopped_ = true; }
  bool cancelled() const override { return stopped_; }

 private:
  std::atomic<bool> stopped_{false};
};

}  // namespace pelage
