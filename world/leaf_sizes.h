// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "world/scene_schema.h"

namespace pelage {

/// Sets how many strands of each coat are grown together, where the scene does not. If the fur of the scene
/// may exceed the memory limit, leaves are so small that some hundred chunks fit: scattered rays reach all of
/// the fur but need few strands in each place. For strands of a file, some dozen chunks fit, because reading
/// fewer strands at a time costs more per strand. If everything fits, leaves are so small that the temporary
/// memory for growing some of them fits too. Sizes have few steps, so that similar limits share stored boxes;
/// with stored trees (render.bvh.file) the size does not depend on the limit, so that one file serves all.
/// Coats with a cache, whose files are for one size, are unchanged, as are strands of a file with stored
/// trees. Does not affect pixels.
void choose_leaf_sizes(SceneDescription& scene);

}  // namespace pelage
