// SPDX-License-Identifier: Apache-2.0
#include "base/job.h"

#include "base/error.h"

namespace pelage {

void Job::check_stop() const {
  if (progress.cancelled()) throw Error(ErrorKind::kStopped, "stopped before the work was done");
}

void Job::for_each(size_t count, size_t grain, const std::function<void(WorkRange)>& body) const {
  workers.for_each(count, grain, [&](WorkRange range) {
    check_stop();
    body(range);
  });
}

}  // namespace pelage
