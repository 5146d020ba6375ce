// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "world/scene_schema.h"

namespace pelage {

/// Adds a problem for each groom that cannot have its `dynamics`, and for each crowd whose animals would have
/// to be simulated.
void check_dynamics(const SceneDescription& scene, Problems& problems);

}  // namespace pelage
