// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/job.h"
#include "procedurals/crowd.h"
#include "world/scene_schema.h"

namespace pelage {

/// Places the crowds of a scene one after the other. Each crowd avoids the animals of the previous crowds.
/// `drawn_bytes`: memory of one animal in a frame, for each character of the scene in order. Before placing
/// any animal, checks each crowd against `render.memory`, including the memory for rendering it. Passes on
/// exceptions of make_crowd().
std::vector<std::vector<CrowdMember>> make_crowds(const SceneDescription& scene,
                                                  const std::vector<int64_t>& drawn_bytes, const Job& job);

}  // namespace pelage
