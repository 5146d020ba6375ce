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
  Report report;  ///< without the facts about machine and runs, which are added for all experiments
  std::vector<Outcome> outcomes;
};

// One function per experiment. Each function runs its variants until all are done or `progress` requests a
// stop, and reports on the variants that were run. It throws Error (kFailed) when the folder of `setup`
// cannot be written.

/// Compares all bounding strategies. Reports time, memory, growth, box tests and pixels that differ.
Measured measure_bounds(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress);

/// Renders under different memory budgets, from the size of all chunks down to a budget that is refused.
Measured measure_residency(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress);

/// Measures the time to grow with and without the operator cache, and the time to grow again after an edit of
/// each operator.
Measured measure_growth(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress);

/// Compares uniform and adaptive sampling. Reports the number of samples for equal error, and the bias.
Measured measure_samplers(const SceneDescription& scene, const MeasureSetup& setup, Progress& progress);

/// Sample counts and parts of `measure shading`.
struct ShadingPlan {
  /// Samples per pixel, ascending; each way to render is measured with each of these counts.
  std::vector<int> samples{4, 16, 64};
  int reference_samples = 256;  ///< samples per pixel of the two reference pictures
  /// Those of `samples` with which each way to render also renders a sequence, to measure its flicker.
  std::vector<int> flicker_samples;
  /// Ways to render, from kShadingParts (lab/measure/shading_curves.h); empty: all.
  std::vector<std::string> parts;
};

/// Compares variants of the integrators `path` and `gather`. Reports the error of pixels and of blocks as a
/// function of CPU time, the error that seeds share, flicker, and the numbers of rays and gather points
/// (points on surfaces whose light `gather` shares among samples).
Measured measure_shading(const SceneDescription& scene, const ShadingPlan& plan, const MeasureSetup& setup,
                         Progress& progress);

/// Renders with 0 to 64 bounces by `path`, and by `gather` with and without the reflection cache. Reports CPU
/// time, the light that each number of bounces adds, and the cells of the cache. `samples`: per pixel.
Measured measure_bounces(const SceneDescription& scene, int samples, const MeasureSetup& setup,
                         Progress& progress);

/// Parts of the report of `measure lod`.
inline constexpr const char* kLodParts[] = {"crowd", "detail", "wedge", "dolly"};

/// Compares reduced detail with full detail. `parts` holds names from kLodParts; empty: all parts.
///   crowd   cost of a whole crowd
///   detail  strands, working set, time and error by criterion, distance, blur and focus
///   wedge   contact sheet: one row per distance, one column per quality
///   dolly   change of the picture while the LOD camera moves
Measured measure_lod(const SceneDescription& scene, const std::vector<std::string>& parts,
                     const MeasureSetup& setup, Progress& progress);

}  // namespace pelage
