// SPDX-License-Identifier: Apache-2.0
#include "cli/unworn_grooms.h"

#include <algorithm>

#include "world/complete_scene.h"

namespace pelage {
namespace {

/// Name of the character and of its material. Strand files state neither.
constexpr const char* kAdded = "unworn";

bool is_worn(const SceneDescription& scene, const std::string& groom) {
  for (const auto& character : scene.characters.items) {
    for (const PartParams& part : character.value.parts) {
      if (part.grooms.find(groom)) return true;
    }
  }
  return false;
}

/// Returns the part of the character on this skin. Adds the part if the character has none.
PartParams& part_on(const NameReference& skin, CharacterParams& character) {
  const auto found = std::find_if(character.parts.begin(), character.parts.end(),
                                  [&](const PartParams& part) { return part.skin.name == skin.name; });
  if (found != character.parts.end()) return *found;
  PartParams& part = character.parts.emplace_back();
  part.skin = skin;
  if (!skin.name.empty()) part.material.name = kAdded;
  return part;
}

}  // namespace

void wear_unworn_grooms(SceneDescription& scene, const std::string& groom) {
  if (groom.empty() && !scene.characters.items.empty()) return;
  const bool has_empty_skin = scene.skins.find(kNoSkin) != nullptr;
  CharacterParams character;
  for (const auto& item : scene.grooms.items) {
    if ((!groom.empty() && item.name != groom) || is_worn(scene, item.name)) continue;
    NameReference skin = item.value.skin;
    if (skin.name.empty() && has_empty_skin) skin.name = kNoSkin;
    part_on(skin, character).grooms.items.push_back({item.name, item.position, {kAdded, item.position}});
  }
  if (character.parts.empty()) return;
  scene.materials.items.push_back({kAdded, {}, MaterialParams()});
  scene.characters.items.push_back({kAdded, {}, std::move(character)});
  Problems problems;
  complete_parts(scene, problems);
  problems.throw_if_any();
}

}  // namespace pelage
