// SPDX-License-Identifier: Apache-2.0
#include "render/film/frame_header.h"

namespace pelage {

ExrAttributes exr_attributes(const FrameHeader& header, const Camera& camera) {
  ExrAttributes attributes;
  attributes["worldToCamera"] = camera.world_to_camera();
  attributes["worldToNDC"] = camera.world_to_ndc();
  attributes["screenWindowWidth"] = camera.screen_window_width();
  attributes["screenWindowCenter"] = camera.screen_window_center();
  attributes["framesPerSecond"] = static_cast<float>(header.frames_per_second);
  attributes["expTime"] =
      static_cast<float>(double{header.shutter.y - header.shutter.x} / header.frames_per_second);
  attributes["pelage:shutter"] = header.shutter;
  attributes["pelage:frame"] = static_cast<float>(header.frame);
  attributes["pelage:metersPerUnit"] = static_cast<float>(header.meters_per_unit);
  attributes["pelage:seed"] = std::to_string(header.seed);
  attributes["pelage:samples"] = static_cast<int>(header.samples);
  attributes["pelage:meanSamples"] = static_cast<float>(header.mean_samples);
  if (!header.adaptive.empty()) attributes["pelage:adaptive"] = header.adaptive;
  if (header.dual) attributes["pelage:indirect"] = "dual";
  attributes["pelage:timeLimited"] = header.time_limited ? 1 : 0;
  attributes["pelage:partial"] = header.partial ? 1 : 0;
  attributes["pelage:renderSeconds"] = static_cast<float>(header.render_seconds);
  attributes["pelage:peakMemoryBytes"] = std::to_string(header.peak_memory_bytes);
  attributes["pelage:version"] = header.program_version;
  attributes["pelage:instructions"] = header.instruction_set;
  attributes["pelage:sceneHash"] = header.scene_hash;
  return attributes;
}

}  // namespace pelage
