// SPDX-License-Identifier: Apache-2.0
#include "render/frame/frame_statistics.h"

#include <algorithm>

namespace pelage {

RenderSeconds& RenderSeconds::operator+=(const RenderSeconds& other) {
  camera_rays += other.camera_rays;
  shadow_rays += other.shadow_rays;
  indirect_rays += other.indirect_rays;
  shading += other.shading;
  return *this;
}

RenderSeconds render_seconds(const TileCosts& tiles, double growth_s) {
  const RayMeter& rays = tiles.rays;
  RenderSeconds result{rays.seconds(RayKind::kCamera), rays.seconds(RayKind::kShadow),
                       rays.seconds(RayKind::kIndirect)};
  const double rest_s = std::max(0.0, tiles.cpu_s - growth_s);
  const double rays_s = result.total();
  if (rays_s > rest_s) {
    for (double* part : {&result.camera_rays, &result.shadow_rays, &result.indirect_rays})
      *part *= rest_s / rays_s;
  }
  result.shading = std::max(0.0, rest_s - rays_s);
  return result;
}

FrameStatistics& FrameStatistics::operator+=(const FrameStatistics& other) {
  growth += other.growth;
  residency += other.residency;
  reads += other.reads;
  trace += other.trace;
  rays += other.rays;
  occlusion += other.occlusion;
  cpu_s += other.cpu_s;
  samples_rejected += other.samples_rejected;
  gather_points += other.gather_points;
  reflections += other.reflections;
  for (const auto& [stage, seconds] : other.stages_s) stages_s[stage] += seconds;
  return *this;
}

}  // namespace pelage
