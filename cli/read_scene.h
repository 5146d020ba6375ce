// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/progress.h"
#include "cli/run_options.h"
#include "world/scene_schema.h"

namespace pelage {

/// Reads the scene that a command names, and shows the warnings. Throws the errors of load_scene().
SceneDescription read_scene(const RunOptions& options, Progress& progress);
/// Does the same. `use`: what rib_use() made of the flags, for a scene that is read more than once.
SceneDescription read_scene(const RunOptions& options, Progress& progress, const RibUse& use);

}  // namespace pelage
