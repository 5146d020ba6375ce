// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "world/scene_schema.h"

namespace pelage {

/// Says for each coat how many strands are grown together, where the scene does not. Where all fur of the
/// scene may not fit the memory limit, so few that some hundred chunks do: rays that are scattered go
/// everywhere and need little wherever they go. Of strands of a file, finding which costs more the fewer are
/// read together, some dozen. Where all fits, so few that growing some of them does too. In few steps, so
/// that limits that are not far from each other share boxes that are kept; where trees are kept
/// (render.bvh.file), whatever the limit, so that one file serves all. Coats with a cache, whose files belong
/// to one size, stay as they are; so do strands of a file where trees are kept. Changes no pixel.
void choose_leaf_sizes(SceneDescription& scene);

}  // namespace pelage
