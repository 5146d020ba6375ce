// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/job.h"
#include "procedurals/crowd/crowd.h"
#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

/// Places the crowds of a scene one after the other, and stands them on their ground. Each crowd keeps its
/// distance from the animals of earlier crowds. `assets`: with the skins. Before placing any animal, throws
/// Error (kMemory) if placing a crowd, or rendering all crowds up to it, does not fit `render.memory`. Throws
/// Error (kInput) if a place has no ground. Passes on the errors of make_crowd().
std::vector<std::vector<CrowdMember>> place_crowds(const SceneDescription& scene, const Assets& assets,
                                                   const Job& job);

}  // namespace pelage
