// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/run.h"
#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

/// Runs the first of two bounding passes ahead of time. Boxes of chunks are stored in files beside the caches
/// of the grooms. For every frame of the scene, reads these boxes, grows the chunks whose boxes are missing,
/// stores the new boxes, and reports on standard output. Skips coats without a cache. Does nothing if the
/// bounding strategy of the scene does not measure strands. Boxes depend on the level of detail; grow_boxes()
/// computes them for the detail that the scene requests. Returns false when cancelled.
bool grow_boxes(const SceneDescription& scene, Assets& assets, Run& run);

}  // namespace pelage
