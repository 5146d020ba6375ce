// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/scene_schema.h"

namespace pelage {

/// Says for each coat how many strands are grown together, where the scene does not: so few that some
/// thousand chunks fit the memory limit, since rays that are scattered go everywhere and need little wherever
/// they go. In few steps, so that limits that are not far from each other share boxes and trees that are
/// kept. Coats with a cache, whose files belong to one size, do not follow the limit. Changes no pixel.
void choose_leaf_sizes(SceneDescription& scene);

}  // namespace pelage
