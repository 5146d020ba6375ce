// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/progress.h"
#include "cli/options.h"
#include "world/scene_schema.h"

namespace pelage {

/// Reads the scene that a command names, and shows the warnings. Throws the errors of load_scene().
SceneDescription read_scene(const Options& options, Progress& progress);

}  // namespace pelage
