// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "lab/measure/shading_runs.h"
#include "lab/report/report.h"

namespace pelage {

/// Values of relMSE, in percent, at which times are compared. Times are interpolated between pictures.
inline constexpr int kShadingTargets[] = {5, 2, 1};

/// Adds text, tables, plots and pictures to `report`. `report.data` must have one row per run. For `path`,
/// its approximations and each way to render with `gather`, writes the difference from the references to the
/// file difference-ID.png in `folder`, where ID is ShadingCurve::id. Throws Error (kFailed) when such a file
/// cannot be written.
void add_shading_sections(const ShadingRuns& all, const ShadingPlan& plan,
                          const std::filesystem::path& folder, Report& report);

}  // namespace pelage
