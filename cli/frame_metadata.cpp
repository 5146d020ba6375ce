// SPDX-License-Identifier: Apache-2.0
#include "cli/frame_metadata.h"

#include <fmt/format.h>

#include "cli/version.h"

namespace pelage {

std::map<std::string, ExrAttribute> frame_metadata(const SceneDescription& scene, const Camera& camera,
                                                   const FrameFacts& facts) {
  std::map<std::string, ExrAttribute> attributes;
  attributes["worldToCamera"] = camera.world_to_camera();
  attributes["worldToNDC"] = camera.world_to_ndc();
  attributes["framesPerSecond"] = scene.units.fps;
  attributes["software"] = fmt::format("pelage {}", version());
  attributes["pelage.version"] = std::string(version());
  attributes["pelage.frame"] = facts.frame;
  attributes["pelage.seed"] = fmt::format("{}", scene.render.seed);
  attributes["pelage.samples"] = static_cast<int>(facts.samples);
  attributes["pelage.partial"] = facts.partial ? 1 : 0;
  attributes["pelage.renderSeconds"] = static_cast<float>(facts.render_seconds);
  attributes["pelage.peakBytes"] = fmt::format("{}", facts.peak_rss_bytes);
  attributes["pelage.metersPerUnit"] = scene.units.meters_per_unit;
  return attributes;
}

}  // namespace pelage
