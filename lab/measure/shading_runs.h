// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lab/measure/experiments.h"
#include "lab/measure/shading_curves.h"
#include "lab/pictures/picture_error.h"

namespace pelage {

/// A run of the experiment `shading`, which renders one picture.
struct ShadingRun {
  /// Index in ShadingRuns::curves; empty for the warm-up and the references.
  std::optional<size_t> curve = {};
  bool last = false;    ///< whether it has the largest sample count of its curve
  bool second = false;  ///< whether it repeats the `last` run of its curve with another seed
  Outcome outcome;
  std::filesystem::path picture;
  std::optional<PictureError> error = {};  ///< error over pixels with fur, relative to the references
  /// Only for `last` runs of `gather`: the error that sharing light between samples causes. It is the part of
  /// the error that is equal in this picture and in `other`; noise is not, because they have different seeds.
  std::optional<PictureError> reuse = {};
  std::filesystem::path other = {};  ///< picture of the run with another seed

  double cpu_s() const { return outcome.number("cpu_s"); }
};

struct ShadingRuns {
  std::vector<ShadingCurve> curves;
  std::vector<ShadingRun> runs;  ///< sorted by the index of their curve
  std::vector<std::filesystem::path> references;
  std::string same_as_gather;  ///< way to render that is left out, see same_as_gather()
};

/// Runs all variants of the experiment. After a variant fails, runs the others nevertheless, unless the
/// warm-up or a reference failed.
ShadingRuns run_shading(const SceneDescription& scene, const ShadingPlan& plan, const MeasureSetup& setup,
                        Progress& progress);

}  // namespace pelage
