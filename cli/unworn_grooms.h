// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "world/scene_schema.h"

namespace pelage {

/// Lets grooms that no character wears grow for a strand file: adds a character that wears them on their
/// skins, where the file of the skin places it. `groom`: the only groom to grow. If it is empty, adds all
/// grooms of a scene without characters; in a scene with characters, the coats of the characters are meant.
void wear_unworn_grooms(SceneDescription& scene, const std::string& groom);

}  // namespace pelage
