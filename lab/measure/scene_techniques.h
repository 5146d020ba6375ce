// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/job.h"
#include "lab/report/report.h"
#include "world/scene_schema.h"

namespace pelage {

/// Renders the first frame of a scene by `path` with each technique that finds light: lights or lobes alone,
/// both by the power heuristic, lights chosen without the lobes, and the same with balls inside skins, with
/// and without the magnets of the scene. Returns the relative variance per sample and per ray, and the mean.
/// Throws the errors of load_assets() and render_frame(). Stops early, with the rows so far, when cancelled.
Table scene_techniques(const SceneDescription& scene, const Job& job);

}  // namespace pelage
