// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "world/scene_schema.h"

namespace pelage {

/// Gives parts of characters without a skin one without a surface (kNoSkin), in a material of the same name.
/// Adds a problem for each part that needs a skin, or the material of its skin.
void complete_parts(SceneDescription& scene, Problems& problems);

/// Copies the length of a unit to the parameters that convert lengths.
void set_scale(SceneDescription& scene);

}  // namespace pelage
