// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/run.h"
#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

/// Does the first of two bounding passes ahead of time: sees to it that the side files of boxes beside the
/// caches of the grooms hold every frame of the scene, grows what they lack, and says on standard output what
/// was done. Coats without a cache remember nothing and are left out, and so is everything where the bounding
/// strategy of the scene measures nothing. Reduced detail has boxes of its own: those of what the scene asks
/// for are grown. Returns false when it was cancelled.
bool grow_boxes(const SceneDescription& scene, Assets& assets, Run& run);

}  // namespace pelage
