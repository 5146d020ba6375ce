// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/value.h"
#include "world/scene_schema.h"

namespace pelage {

/// Adds a problem for each groom whose `dynamics.files` cannot hold the guides of every frame: no placeholder
/// for the frame number, no strand file, more than one coat, or keys beside it that have no effect.
/// `document`: of the scene.
void check_motion_files(const SceneDescription& scene, const Value& document, Problems& problems);

}  // namespace pelage
