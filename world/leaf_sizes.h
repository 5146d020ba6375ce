// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "world/scene_schema.h"

namespace pelage {

/// Sets the number of strands per leaf (GroomParams::leaf_strands) of coats for which the scene does not set
/// it. A leaf becomes one chunk, the unit that is grown and evicted. The size of leaves does not affect
/// pixels.
///
/// If the fur of the scene may exceed the memory limit, leaves are so small that 400 chunks fit the limit,
/// because scattered rays reach all of the fur but need few strands at each place. If the strands of the coat
/// come from a file, leaves are so small that only 32 chunks fit, because reading few strands at a time costs
/// more per strand. If all fur fits the limit, leaves are so small that 8 chunks fit, so that there is
/// temporary memory for growing chunks. Sizes are the max size divided by a power of 4, but not smaller than
/// a minimum, so that similar limits can use the same stored boxes.
///
/// If the scene stores trees (render.bvh.file), the size does not depend on the limit, so that one file can
/// be used with every limit; coats with strands from a file are not changed. Coats with a cache are never
/// changed, because the files of a cache are for one size. Without a limit and without stored trees, nothing
/// is changed.
void choose_leaf_sizes(SceneDescription& scene);

}  // namespace pelage
