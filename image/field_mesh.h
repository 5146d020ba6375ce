// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "image/field_nodes.h"

// Fields that read the mesh of a skin (image/field_skin.h). `position`: where the scene has the block, for
// the errors of with_textures().

namespace pelage {

/// `channel`: index of a channel, or empty for the colour.
Field vertex_color_field(std::optional<int> channel, SourcePosition position);
Field group_field(std::string group, SourcePosition position);
/// Returns the mean curvature times `scale`.
Field curvature_field(float scale, SourcePosition position);
/// Returns the distance from the line where `region` is 0.5.
Field boundary_distance_field(Field region, SourcePosition position);
Field mesh_distance_field(AssetPath mesh);

}  // namespace pelage
