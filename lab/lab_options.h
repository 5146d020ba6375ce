// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "cli/run_options.h"

namespace pelage {

enum class LabTask { kMeasure, kCompare };

enum class Experiment { kBounces, kBounds, kGrowth, kLod, kResidency, kSamplers, kShading };
const char* experiment_name(Experiment experiment);

/// The command line of pelage-lab. Each command reads only the members that concern it.
struct LabOptions : RunOptions {
  LabTask task = LabTask::kMeasure;

  Experiment experiment = Experiment::kBounds;  ///< measure: the experiment
  int repeat = 3;                               ///< measure: runs of each variant
  double time_limit_s = 600;                    ///< measure: a run that takes longer is stopped

  std::vector<std::string> parts;  ///< measure lod, shading: parts of the report; empty: all parts

  /// For `measure shading`: samples per pixel, one run of each variant per count.
  std::vector<int> samples{4, 16, 64};
  int reference_samples = 256;  ///< measure shading: samples per pixel of the two reference pictures
  /// For `measure shading`: those of `samples` whose flicker is measured, ascending. The smallest of
  /// `samples` by default; none with --flicker-samples 0.
  std::vector<int> flicker_samples;

  std::vector<std::string> models;  ///< compare: --models; empty: all models
};

/// Parses a command line. Returns nothing when help or the version was requested, after writing that text to
/// `out`. Throws Error (kArguments) for mistakes.
std::optional<LabOptions> parse_lab_options(const std::vector<std::string>& arguments, std::ostream& out);

// The commands. Each returns the exit code of the process. It throws Error for mistakes of the user and
// failures of the system.

int run_measure(const LabOptions& options);
int run_compare(const LabOptions& options);

}  // namespace pelage
