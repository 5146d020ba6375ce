// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lab/measure/experiments.h"
#include "lab/measure/shading_curves.h"
#include "lab/pictures/picture_error.h"
#include "lab/pictures/systematic_error.h"

namespace pelage {

/// Number of frames of the sequences whose flicker is measured.
inline constexpr int kFlickerFrames = 8;

/// A run of the experiment `shading`, which renders one picture, or a sequence of kFlickerFrames.
struct ShadingRun {
  /// Index in ShadingRuns::curves; empty for the warm-up and the references.
  std::optional<size_t> curve = {};
  int samples = 0;     ///< number that ShadingPlan::samples states
  bool last = false;   ///< whether it has the largest sample count of its curve
  bool extra = false;  ///< whether it is no point of its curve: a picture with another seed, or a sequence
  Outcome outcome;
  std::filesystem::path picture;
  std::optional<PictureError> error = {};  ///< error over pixels with fur, relative to the references
  /// Only for `last` runs: the part of the error that is equal in this picture and in `other`, of pixels and
  /// of blocks. Noise is not equal, because the seeds differ. Sharing light between samples causes such
  /// errors.
  std::optional<PictureError> shared = {};
  std::optional<SystematicError> systematic = {};
  std::filesystem::path other = {};  ///< picture of the run with another seed
  /// Flicker of fur with these settings, see lab/pictures/flicker.h. NaN where it is not measured.
  double flicker = NAN;

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
