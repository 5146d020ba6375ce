// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "procedurals/posed_character_skin.h"
#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

/// A visible character: a single one, or an animal of a crowd.
struct DrawnCharacter {
  std::string name;       ///< "rat", or "colony.17" for an animal of a crowd, counted from 0
  std::string prototype;  ///< the character of the scene that it is an instance of
  const CharacterParams* params = nullptr;
  std::optional<CrowdMember> member;
};

/// All visible characters of a scene, first single ones, then crowds, in the order of the scene. `scene` must
/// outlive the result.
std::vector<DrawnCharacter> drawn_characters(const SceneDescription& scene, const Assets& assets);

/// Memory of one animal of a character in a frame: names, posed cages and the description of the coats.
/// Excludes grown hair and whole poses.
int64_t drawn_character_bytes(const SceneDescription& scene, const Assets& assets, const std::string& name,
                              const CharacterParams& character);

/// Whether hair grows on the character.
bool has_coat(const DrawnCharacter& character);

/// Selects `count` characters that keep all their hair; all when fewer have a coat. Sorts the characters with
/// a coat by distance from `eye`, divides them into `count` equal groups and selects the middle character of
/// each group, so that near and far characters are sampled equally.
std::vector<bool> full_detail_characters(const std::vector<DrawnCharacter>& characters, int64_t count,
                                         const V3f& eye, double frame);

/// The posed cages of one part of a character: over the shutter, and at the ends of the frame's interval if
/// something moves while the shutter is open.
CharacterPose pose_character(const DrawnCharacter& character, size_t part, const Assets& assets,
                             const CameraParams& camera, double frame);

}  // namespace pelage
