// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/shading_curves.h"

#include <algorithm>

#include <fmt/format.h>

namespace pelage {
namespace {

ShadingCurve path(const char* id, const char* title, const char* filter_samples) {
  ShadingCurve curve{id, title, {}};
  curve.settings = {{"render.integrator", "path"}, {"image.filter_samples", filter_samples}};
  return curve;
}

ShadingCurve gather(const char* id, const std::string& title) {
  ShadingCurve curve{id, title, {}, true};
  curve.settings = {{"render.integrator", "gather"}, {"image.filter_samples", "splatted"}};
  return curve;
}

/// `gather` with one other setting.
ShadingCurve gather_with(const char* key, const std::string& value) {
  ShadingCurve curve = gather(key, fmt::format("gather, {}: {}", key, value));
  curve.settings.emplace_back(fmt::format("render.gather.{}", key), value);
  return curve;
}

}  // namespace

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
      gather_with("cache", own.cache ? "false" : "true"),
      gather("drawn", "gather, drawn")};
  curves[2].adaptive = true;
  curves.back().settings.back().second = "drawn";
  std::erase_if(curves, [&](const ShadingCurve& curve) {
    return !parts.empty() && curve.id != "path" &&
           std::find(parts.begin(), parts.end(), curve.id) == parts.end();
  });
  return curves;
}

}  // namespace pelage
