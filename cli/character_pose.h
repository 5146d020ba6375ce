// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/assets.h"
#include "cli/scene_schema.h"
#include "procedurals/posed_character_skin.h"

namespace pelage {

/// The posed cages of one skin of a character: over the shutter, and at the ends of the frame's interval when
/// something moves while the shutter is open.
CharacterPose pose_character(const Assets::Skin& skin, const CharacterParams& character,
                             const CameraParams& camera, double frame);

}  // namespace pelage
