// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "world/scene_schema.h"

namespace pelage {

/// Sets the number of strands per leaf for each coat for which the scene does not set it. If the fur of the
/// scene may exceed the memory limit, leaves are so small that some hundred chunks fit the limit: scattered
/// rays reach all of the fur but need few strands in each place. For strands of a file, leaves are so small
/// that some dozen chunks fit, because reading fewer strands at a time costs more per strand. If all fur
/// fits, leaves are so small that the temporary memory for growing some of them fits too. Sizes are rounded
/// to a few steps, so that similar limits share stored boxes. With stored trees (render.bvh.file), the size
/// does not depend on the limit, so that one file can be used with every limit. Does not change coats with a
/// cache, whose files are for one size, nor strands of a file with stored trees. Does not affect pixels.
void choose_leaf_sizes(SceneDescription& scene);

}  // namespace pelage
