// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lab/report/report.h"
#include "lab/runs/variant.h"
#include "world/scene_schema.h"

namespace pelage {

/// Result of an experiment.
struct Measured {
  Report report;  ///< without the facts about machine and runs, which all experiments share
  std::vector<Outcome> outcomes;
};

// One function per experiment. Each function runs its variants until all are done or `progress` requests a
// stop, and reports on the variants that were run. Throws Error (kFailed) when the folder cannot be written.

/// Acceleration structures for fur: memory, build time, speed for several kinds of rays, tests, page faults.
Measured measure_accel(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress);

/// Every bounding strategy: time, memory, growth, box tests, lost pixels.
Measured measure_bounds(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress);

/// Memory budgets, from the size of all chunks down to a budget that is refused.
Measured measure_residency(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress);

/// Time to grow with and without the operator cache, and per operator.
Measured measure_growth(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress);

/// Uniform and adaptive sampling: samples at equal error, and bias.
Measured measure_samplers(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress);

/// What `measure shading` runs.
struct ShadingPlan {
  std::vector<int> samples{4, 16, 64};  ///< per pixel, ascending: a picture of each curve with each
  int reference_samples = 256;
  std::vector<std::string> parts;  ///< names from kShadingParts (lab/measure/shading_curves.h); empty: all
};

/// `path` and `gather` in several ways: error over time, bias, rays, knots.
Measured measure_shading(const SceneDescription& scene, const ShadingPlan& plan, const MeasureSetup& setup,
                         Progress& progress);

/// Reduced detail against full detail. `parts`: names from kLodParts, or empty for all:
///   crowd   cost of the whole crowd in full detail, extrapolated from `full_detail` characters
///   detail  hairs, working set, time and error by criterion, distance, blur and focus
///   wedge   contact sheet: a row per distance, a column per quality
///   dolly   change of the picture while the LOD camera moves
Measured measure_lod(const SceneDescription& scene, const std::vector<int>& full_detail,
                     const std::vector<std::string>& parts, const MeasureSetup& setup, Progress& progress);

}  // namespace pelage
