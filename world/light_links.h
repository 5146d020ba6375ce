// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/scene/render_scene.h"
#include "world/scene_schema.h"

namespace pelage {

/// Checks the names in `illuminates` and `shadowed_by` of the lights of a scene. Adds a problem, with the
/// nearest name, for each name that is no character, crowd, archive, coat or skin, and for lights without
/// shadows that name what casts them.
void check_light_links(const SceneDescription& scene, Problems& problems);

/// Tells a light of the scene which coats and skins of a frame receive it, and which cast shadows in it. The
/// name of a character includes its copies in crowds.
void link_light(const LightParams& params, const std::vector<FurPart>& fur,
                const std::vector<SkinPart>& skins, Light& light);

}  // namespace pelage
