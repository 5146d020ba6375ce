// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/options.h"
#include "cli/run.h"
#include "world/scene_schema.h"

namespace pelage {

/// The command `render --estimate`: prints the estimate of all frames. Returns the exit code.
int print_estimate(const SceneDescription& scene, const Options& options, Run& run);

}  // namespace pelage
