// SPDX-License-Identifier: Apache-2.0
#include "world/light_links.h"

#include <algorithm>

#include "base/nearest_name.h"

namespace pelage {
namespace {

using Names = std::optional<std::vector<NameReference>>;

std::vector<std::string> linkable_names(const SceneDescription& scene) {
  std::vector<std::string> names;
  for (const auto& character : scene.characters.items) {
    names.push_back(character.name);
    for (const PartParams& part : character.value.parts) {
      if (part.skin.name != kNoSkin) names.push_back(character.name + "." + part.skin.name);
      for (const auto& groom : part.grooms.items) names.push_back(character.name + "." + groom.name);
    }
  }
  for (const auto& crowd : scene.crowds.items) names.push_back(crowd.name);
  for (const auto& archive : scene.archives.items) names.push_back(archive.name);
  return names;
}

/// Whether `name` names a part, or something that contains the part.
bool includes(const std::string& name, const std::string& part) {
  return part.starts_with(name) && (part.size() == name.size() || part[name.size()] == '.');
}

std::shared_ptr<const PartSet> parts_of(const Names& names, const std::vector<FurPart>& fur,
                                        const std::vector<SkinPart>& skins) {
  if (!names) return nullptr;
  auto set = std::make_shared<PartSet>();
  const auto add = [&](const auto& parts, bool are_skins) {
    for (uint32_t i = 0; i < parts.size(); ++i) {
      const bool named = std::any_of(names->begin(), names->end(), [&](const NameReference& reference) {
        return includes(reference.name, parts[i].name) || includes(reference.name, parts[i].prototype);
      });
      if (named) set->add({are_skins, i});
    }
  };
  add(fur, false);
  add(skins, true);
  return set;
}

}  // namespace

void check_light_links(const SceneDescription& scene, Problems& problems) {
  const std::vector<std::string> known = linkable_names(scene);
  const auto check = [&](const Names& names) {
    if (!names) return;
    for (const NameReference& reference : *names) {
      if (std::find(known.begin(), known.end(), reference.name) != known.end()) continue;
      problems.add(reference.position,
                   "there is no character, crowd, archive, coat or skin " + quote(reference.name) +
                       (known.empty() ? "; the scene has none" : suggest(reference.name, known)));
    }
  };
  for (const auto& item : scene.lights.items) {
    std::visit(
        [&](const LightEmission& light) {
          check(light.illuminates);
          check(light.shadowed_by);
          if (!light.shadows && light.shadowed_by)
            problems.add(item.position,
                         "light " + quote(item.name) +
                             " has `shadows: false`, so `shadowed_by` has no effect; remove one");
        },
        item.value);
  }
}

void link_light(const LightParams& params, const std::vector<FurPart>& fur,
                const std::vector<SkinPart>& skins, Light& light) {
  std::visit(
      [&](const LightEmission& of) {
        light.link(parts_of(of.illuminates, fur, skins), parts_of(of.shadowed_by, fur, skins));
      },
      params);
}

}  // namespace pelage
