// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/job.h"
#include "procedurals/crowd.h"
#include "world/scene_schema.h"

namespace pelage {

/// Places the crowds of a scene, one after the other, each clear of those before it. `drawn_bytes`: of each
/// character of the scene, in its order, what one animal of it will hold in a frame. Before any is placed,
/// each crowd is checked against `render.memory`, with what drawing it will take. Throws what make_crowd()
/// throws.
std::vector<std::vector<CrowdMember>> make_crowds(const SceneDescription& scene,
                                                  const std::vector<int64_t>& drawn_bytes, const Job& job);

}  // namespace pelage
