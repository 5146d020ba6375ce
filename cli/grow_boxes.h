// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/run.h"
#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

/// Computes the boxes of chunks before rendering, so that a later render reads them instead of growing all
/// fur for them. The boxes are stored in files beside the caches of the grooms.
///
/// For every frame of the scene, reads the stored boxes, grows the chunks whose boxes are missing, stores the
/// new boxes, and reports on standard output. Skips coats without a cache. Does nothing if the bounding
/// strategy of the scene does not measure strands. Boxes depend on the level of detail: the boxes are those
/// for the detail that the scene requests. Returns false when cancelled.
bool grow_boxes(const SceneDescription& scene, Assets& assets, Run& run);

}  // namespace pelage
