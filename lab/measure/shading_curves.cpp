// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/shading_curves.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace pelage {
namespace {

ShadingCurve path(const char* id, const char* title, const char* filter_samples) {
  ShadingCurve curve{id, title, {}};
  curve.settings = {
      {"render.indirect", "path"}, {"render.integrator", "path"}, {"image.filter_samples", filter_samples}};
  return curve;
}

ShadingCurve gather(const char* id, const std::string& title) {
  ShadingCurve curve{id, title, {}, true};
  curve.settings = {
      {"render.indirect", "path"}, {"render.integrator", "gather"}, {"image.filter_samples", "splatted"}};
  return curve;
}

/// `gather` with one other setting. `id`: of the curve; by default, the key.
ShadingCurve gather_with(const char* key, const std::string& value, const char* id = nullptr) {
  ShadingCurve curve = gather(id ? id : key, fmt::format("gather, {}: {}", key, value));
  curve.settings.emplace_back(fmt::format("render.gather.{}", key), value);
  return curve;
}

/// A curve with a value of render.skin_ball.
ShadingCurve with_balls(ShadingCurve curve, const char* use) {
  curve.settings.insert(curve.settings.begin(), {"render.skin_ball", use});
  return curve;
}

/// `path` or `gather` with the opposite of one switch of the scene.
ShadingCurve switched(ShadingCurve curve, const char* key, bool scene_value) {
  const char* value = scene_value ? "false" : "true";
  curve.id = curve.gather ? fmt::format("gather_{}", key) : key;
  curve.title += fmt::format(", {}: {}", key, value);
  curve.settings.emplace_back(fmt::format("render.{}", key), value);
  return curve;
}

/// A curve with everything that may save shadow rays or make them cheaper.
ShadingCurve with_all(ShadingCurve curve) {
  curve.settings.emplace_back("render.skin_ball", "exact");
  curve.settings.emplace_back("render.screen_door", "true");
  return curve;
}

}  // namespace

ShadingCurve reference_curve() {
  return {"reference",
          "reference",
          {{"render.indirect", "path"},
           {"render.integrator", "path"},
           {"image.filter_samples", "splatted"},
           {"render.skin_ball", "off"},
           {"render.screen_door", "false"}}};
}

std::string same_as_gather(const SceneDescription& scene) {
  size_t skins = scene.crowds.items.empty() && scene.archives.items.empty() ? 0 : RenderParams::kFewSkins + 1;
  for (const auto& character : scene.characters.items) skins += character.value.parts.size();
  RenderParams render = scene.render;
  render.gather.reuse = true;
  const bool caches = render.uses_cache(skins);
  // Some characters may not be drawn, or crowds and archives may be small.
  if (caches != render.uses_cache(0) && skins > RenderParams::kFewSkins) return "";
  return caches ? "cache" : "no_cache";
}

std::vector<ShadingCurve> shading_curves(const SceneDescription& scene,
                                         const std::vector<std::string>& parts) {
  const GatherParams& own = scene.render.gather;
  std::vector<ShadingCurve> curves{
      path("path", "path", "drawn"),
      path("splatted", "path, splatted", "splatted"),
      path("adaptive", "path, adaptive", "drawn"),
      gather("gather", "gather"),
      gather_with("visibility", scene.render.draws_visible() ? "rays" : "raster"),
      gather_with("reuse", "false"),
      gather_with("spacing", fmt::format("{:g}", 2 * own.spacing)),
      gather_with("skin_spacing", fmt::format("{:g}", 2 * own.skin_spacing)),
      gather_with("cells", own.cells ? "false" : "true"),
      gather_with("light_rays", fmt::format("{:g}", own.light_rays / 2)),
      gather_with("paths", fmt::format("{:g}", own.paths / 2)),
      gather_with("cache", "true"),
      gather_with("cache", "false", "no_cache"),
      gather("drawn", "gather, drawn")};
  curves[2].adaptive = true;
  for (ShadingCurve& curve : curves) {  // a cache needs reuse, whatever the scene says
    if (curve.id == "reuse") curve.settings.emplace_back("render.gather.cache", "false");
    if (curve.id == "cache") curve.settings.emplace_back("render.gather.reuse", "true");
  }
  curves.back().settings.back().second = "drawn";
  for (const ShadingCurve& curve : {curves[0], gather("", "gather")}) {
    curves.push_back(switched(curve, "screen_door", scene.render.screen_door));
  }
  curves.push_back(path("dual", "path, indirect: dual", "drawn"));
  curves.back().settings.front().second = "dual";
  for (ShadingCurve& curve : curves) curve = with_balls(std::move(curve), "off");
  curves.push_back(with_balls(path("skin_ball", "path, skin_ball: exact", "drawn"), "exact"));
  curves.push_back(with_balls(gather("gather_skin_ball", "gather, skin_ball: exact"), "exact"));
  curves.push_back(with_all(path("together", "path, together", "drawn")));
  curves.push_back(with_all(gather("gather_together", "gather, together")));
  const std::string same = same_as_gather(scene);
  std::erase_if(curves, [&](const ShadingCurve& curve) { return curve.id == same; });
  std::erase_if(curves, [&](const ShadingCurve& curve) {
    return !parts.empty() && curve.id != "path" &&
           std::find(parts.begin(), parts.end(), curve.id) == parts.end();
  });
  return curves;
}

}  // namespace pelage
