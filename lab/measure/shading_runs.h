// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "lab/measure/experiments.h"
#include "lab/measure/shading_curves.h"
#include "lab/pictures/picture_error.h"

namespace pelage {

/// A run of the experiment `shading`.
struct ShadingRun {
  std::optional<size_t> curve = {};  ///< index; empty: warm-up and references
  bool last = false;                 ///< most samples of its curve
  bool second = false;               ///< the same picture as the last one, with another seed
  Outcome outcome;
  std::filesystem::path picture;
  std::optional<PictureError> error = {};  ///< on fur, against the references
  /// Error that this picture shares with `other` and not with the references; of `last` runs of gather.
  std::optional<PictureError> reuse = {};
  std::filesystem::path other = {};  ///< the second picture

  double cpu_s() const { return outcome.number("cpu_s"); }
};

struct ShadingRuns {
  std::vector<ShadingCurve> curves;
  std::vector<ShadingRun> runs;  ///< in the order of the curves
  std::vector<std::filesystem::path> references;
};

/// Runs the variants. A variant that fails does not stop the others, unless it is a reference.
ShadingRuns run_shading(const SceneDescription& scene, const ShadingPlan& plan, const MeasureSetup& setup,
                        Progress& progress);

}  // namespace pelage
