// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "base/job.h"
#include "procedurals/crowd/crowd.h"
#include "world/scene_schema.h"

namespace pelage {

/// Places the crowds of a scene one after the other. Each crowd keeps its distance from the animals of
/// earlier crowds. Before placing any animal, throws Error (kMemory) if placing a crowd, or rendering all
/// crowds up to it, does not fit `render.memory`. Passes on the errors of make_crowd(). `drawn_bytes`: for
/// each character of the scene, in order, the memory of one animal in a frame (frame_character_bytes()).
std::vector<std::vector<CrowdMember>> make_crowds(const SceneDescription& scene,
                                                  const std::vector<int64_t>& drawn_bytes, const Job& job);

}  // namespace pelage
