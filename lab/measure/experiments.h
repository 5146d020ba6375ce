// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "lab/report/report.h"
#include "lab/runs/variant.h"
#include "world/scene_schema.h"

namespace pelage {

/// What an experiment found.
struct Measured {
  Report report;  ///< without the facts of the machine and the runs, which are the same for all experiments
  std::vector<Outcome> outcomes;
};

// One function per experiment. Each runs its variants until all are done or progress says that the user
// wants to stop, and reports on those that were run. Throws Error (kFailed) when the folder cannot be
// written.

/// What fur is traced with: memory, time to build, speed for several kinds of rays, tests, page faults.
Measured measure_accel(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress);

/// Every bounding strategy: time, memory, growth, box tests, lost pixels.
Measured measure_bounds(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress);

/// Memory budgets from the whole of what the chunks take down to what is refused.
Measured measure_residency(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress);

/// Growth with and without the operator cache, and by operator.
Measured measure_growth(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress);

/// Plain and adaptive sampling: samples at equal error, and bias.
Measured measure_samplers(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress);

/// Level of detail against full detail: what full detail of a whole crowd would take, from `full_detail` of
/// its characters (`crowd`); hairs, working set, time and error by idea, distance, blur and focus (`detail`);
/// distances by qualities (`wedge`); what changes in the picture while the camera of the detail moves
/// (`dolly`). `parts`: of kLodParts, or empty for all.
Measured measure_lod(const SceneDescription& scene, const std::vector<int>& full_detail,
                     const std::vector<std::string>& parts, const MeasureSetup& setup, Progress& progress);

}  // namespace pelage
