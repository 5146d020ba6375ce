// SPDX-License-Identifier: Apache-2.0
#include "view/light_mix.h"

#include <cmath>
#include <limits>
#include <variant>

#include "base/nearest_name.h"

namespace pelage {
namespace {

const LightParams& find_light(const SceneDescription& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const auto& light : scene.lights.items) {
    if (light.name == name) return light.value;
    names.push_back(light.name);
  }
  throw Error(ErrorKind::kArguments, "no light " + quote(name) + suggest(name, names));
}

}  // namespace

std::vector<ValueEdit> light_edits(const SceneDescription& scene, const std::vector<LightMix>& mixes) {
  std::vector<ValueEdit> edits;
  for (const LightMix& mix : mixes) {
    const LightParams& light = find_light(scene, mix.light);
    const auto [radiance, intensity] =
        std::visit([](const auto& params) { return std::pair(params.radiance, params.intensity); }, light);
    const double gain = std::exp2(mix.stops);
    const bool animated = !intensity.is_constant();
    if (mix.stops != 0 && !animated)
      edits.push_back({{"lights", mix.light, "intensity"}, {gain * double{intensity.at(0)}}});
    const Rgb factor = mix.tint * (animated ? static_cast<float>(gain) : 1.0f);
    if (factor == Rgb(1)) continue;
    const Rgb changed = radiance * factor;
    edits.push_back({{"lights", mix.light, "radiance"}, {changed.x, changed.y, changed.z}});
  }
  for (const ValueEdit& edit : edits) {
    for (const double number : edit.numbers) {
      if (!(number <= double{std::numeric_limits<float>::max()}))
        throw Error(ErrorKind::kArguments, "lights." + edit.path[1] + ": the light is too bright");
    }
  }
  return edits;
}

}  // namespace pelage
