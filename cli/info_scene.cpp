// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "base/counted.h"
#include "cli/info.h"

namespace pelage {
namespace {

template <class T>
std::string shown_value(const T& value) {
  return ValueReader<T>::print(value);
}

std::string describe_item(const SkinParams& skin) {
  if (skin.mesh.empty()) return "strands without a surface";
  std::string text = fmt::format("{}, {}", skin.mesh.path.string(), shown_value(skin.scheme));
  if (skin.poses) {
    text += fmt::format(", {} poses{}", skin.poses->count, skin.poses->cycle ? " in a cycle" : "");
  }
  return text;
}

std::string strands_of(const GroomParams& groom) {
  if (!groom.strands_file.empty()) return "strands from " + groom.strands_file.path.string();
  const std::string count = groom.strands ? fmt::format("{} strands", *groom.strands) : "strands by density";
  return fmt::format("{} with {} points on {}", count, groom.points, groom.skin.name);
}

std::string describe_item(const GroomParams& groom) {
  std::string text = fmt::format("{}, {}", strands_of(groom), shown_value(groom.role));
  for (size_t i = 0; i < groom.operators.items.size(); ++i) {
    text += (i ? ", " : ": ") + groom.operators.items[i].name;
  }
  return text;
}

template <class... Ps>
std::string kind_of(const std::variant<Ps...>& params) {
  return std::visit([](const auto& p) { return std::string(p.kTypeName); }, params);
}

std::string describe_item(const CharacterParams& character) {
  std::string text;
  for (const PartParams& part : character.parts) {
    text += fmt::format("{}{} in {}", text.empty() ? "" : "; ", part.skin.name, part.material.name);
    for (size_t i = 0; i < part.grooms.items.size(); ++i) {
      const auto& groom = part.grooms.items[i];
      text += fmt::format("{}{} in {}", i ? ", " : " with ", groom.name, groom.value.name);
    }
  }
  return text;
}

std::string describe_item(const CrowdParams& crowd) {
  std::string text;
  for (const NameReference& of : crowd.of) text += (text.empty() ? "" : ", ") + of.name;
  return fmt::format("{} of {}", crowd.count, text);
}

std::string describe_item(const ArchiveParams& archive) {
  return fmt::format("{}, {}", archive.rib.path.string(),
                     counted(static_cast<int64_t>(archive.materials.items.size()), "surface"));
}

std::string describe_item(const LightParams& light) {
  std::string text = kind_of(light);
  const auto add_names = [&](const char* title, const std::optional<std::vector<NameReference>>& names) {
    if (!names) return;
    for (size_t i = 0; i < names->size(); ++i)
      text += fmt::format("{}{}", i == 0 ? title : ", ", (*names)[i].name);
    if (names->empty()) text += fmt::format("{}nothing", title);
  };
  std::visit(
      [&](const LightEmission& common) {
        if (common.temperature) text += fmt::format(", {} K", *common.temperature);
        if (common.visible) text += ", visible";
        if (!common.shadows) text += ", without shadows";
        add_names(", illuminates ", common.illuminates);
        add_names(", shadowed by ", common.shadowed_by);
      },
      light);
  return text;
}
std::string describe_item(const MagnetParams& magnet) { return kind_of(magnet); }
std::string describe_item(const MaterialParams& material) { return kind_of(material); }

template <class T>
std::string section(const char* title, const Named<T>& named) {
  std::string text = fmt::format("{} {}\n", named.items.size(), title);
  for (const auto& item : named.items)
    text += fmt::format("  {}: {}\n", item.name, describe_item(item.value));
  return text;
}

}  // namespace

std::string describe_scene(const SceneDescription& scene) {
  std::string text =
      fmt::format("scene, {} x {} pixels, frames {}, {}, {}, integrator {}\n", scene.image.width,
                  scene.image.height, shown_value(scene.frames), counted(scene.render.samples, "sample"),
                  counted(scene.render.bounces, "bounce"), shown_value(scene.render.integrator));
  text +=
      section("skins", scene.skins) + section("grooms", scene.grooms) + section("materials", scene.materials);
  text += section("characters", scene.characters);
  if (!scene.crowds.items.empty()) text += section("crowds", scene.crowds);
  if (!scene.archives.items.empty()) text += section("archives", scene.archives);
  if (!scene.magnets.items.empty()) text += section("magnets", scene.magnets);
  return text + section("lights", scene.lights);
}

}  // namespace pelage
