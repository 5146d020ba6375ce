// SPDX-License-Identifier: Apache-2.0
#include "render/frame/sample_scratch.h"

#include "render/frame/frame_statistics.h"

namespace pelage {

void SampleScratch::add_to(FrameStatistics& statistics) const {
  statistics.samples_rejected += rejected;
  statistics.trace += thread.counts;
  statistics.rays += costs.rays.counts();
}

}  // namespace pelage
