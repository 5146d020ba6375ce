// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/hash.h"
#include "world/scene_schema.h"

namespace pelage {

// Hashes of everything from which an asset is made: its part of the scene, and the stamps of its files. Equal
// keys mean equal assets within one process. Take a key before the files are read: if a file changes
// meanwhile, the next key is different.

ContentHash skin_key(const SceneDescription& scene, const std::string& name, const SkinParams& params);

/// `skin`: the key of the skin on which the groom grows; anything for a groom without a skin.
ContentHash groom_key(const SceneDescription& scene, const std::string& name, const GroomParams& params,
                      const ContentHash& skin);

}  // namespace pelage
