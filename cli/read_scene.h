// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/progress.h"
#include "cli/options.h"
#include "world/scene_schema.h"

namespace pelage {

/// Reads the scene of a command and shows its warnings. Throws like load_scene().
SceneDescription read_scene(const Options& options, Progress& progress);

}  // namespace pelage
