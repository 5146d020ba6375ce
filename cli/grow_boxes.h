// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/run.h"
#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

/// Runs the first of two bounding passes ahead of time. Ensures that the side files of boxes beside the
/// caches of the grooms contain every frame of the scene, grows what is missing, and reports on standard
/// output. Skips coats without a cache, and everything when the scene's bounding strategy does not measure.
/// Boxes depend on the level of detail: computes them for the detail that the scene requests. Returns false
/// when cancelled.
bool grow_boxes(const SceneDescription& scene, Assets& assets, Run& run);

}  // namespace pelage
