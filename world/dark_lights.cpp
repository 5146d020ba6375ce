// SPDX-License-Identifier: Apache-2.0
#include "world/dark_lights.h"

#include <algorithm>
#include <variant>

namespace pelage {

std::optional<std::string> why_dark(const SceneDescription& scene) {
  const auto shines = [](const auto& light) {
    const auto& keys = light.intensity.keys();
    if constexpr (requires { light.power > 0; }) {
      if (!std::optional<float>(light.power).value_or(1)) return false;
    }
    return max_component(light.radiance) > 0 &&
           std::any_of(keys.begin(), keys.end(), [](const auto& key) { return key.second > 0; });
  };
  for (const auto& light : scene.lights.items) {
    if (std::visit(shines, light.value)) return {};
  }
  if (!scene.lights.items.empty())
    return "every light has the radiance or intensity 0: pictures will be black";
  return scene.from_rib ? "there is no light: pictures will be black; add a LightSource that Pelage supports"
                        : "there is no light: pictures will be black; add one to `lights`";
}

void warn_of_dark_lights(const SceneDescription& scene, const Value& document,
                         std::vector<Problem>& warnings) {
  for (const auto& light : scene.lights.items) {
    const auto* panel = std::get_if<RectangleLightParams>(&light.value);
    if (!panel || !panel->barn_doors) continue;
    if (!panel->barn_doors->are_closed(panel->size * 0.5f, SpreadGrid(panel->spread).max_slope())) continue;
    const Value& block = *document.find("lights")->find(light.name);
    warnings.push_back(
        {block.find("barn_doors")->position(), "the barn doors are closed: no light passes between them"});
  }
}

}  // namespace pelage
