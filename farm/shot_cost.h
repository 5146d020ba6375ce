// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "farm/farm_plan.h"
#include "world/run_estimate.h"

namespace pelage {

/// CPU seconds of a shot, roughly.
struct ShotCost {
  double whole_s = 0;  ///< if its frames were not divided
  /// Max extra time caused by regions, because each repeats start-up, bounding and growth.
  double repeated_s = 0;
};

/// Returns the frames from which a shot is estimated: the first, the middle and the last one.
std::vector<int> frames_to_estimate(const std::vector<int>& frames);

/// `estimate`: of frames_to_estimate(). `stores`: whether the scene stores its fur on disk (render.bvh.file).
ShotCost shot_cost(const FarmRequest& request, const RunEstimate& estimate, bool stores);

/// Returns the memory to reserve for each render of a shot.
uint64_t reserved_bytes(const RunEstimate& estimate);

}  // namespace pelage
