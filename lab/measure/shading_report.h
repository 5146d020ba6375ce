// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "lab/measure/shading_runs.h"
#include "lab/report/report.h"

namespace pelage {

/// relMSE in percent to which times are interpolated.
inline constexpr int kShadingTargets[] = {5, 2, 1};

/// Adds text, tables, plots and pictures. `report.data` has a row for each run. Writes
/// difference-CURVE.png to `folder` for every difference. Throws Error (kFailed) when it cannot be written.
void add_shading_sections(const ShadingRuns& all, const ShadingPlan& plan,
                          const std::filesystem::path& folder, Report& report);

}  // namespace pelage
