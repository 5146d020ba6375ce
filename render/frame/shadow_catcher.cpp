// SPDX-License-Identifier: Apache-2.0
#include "render/frame/shadow_catcher.h"

#include <algorithm>
#include <variant>

#include "render/frame/camera_samples.h"
#include "render/frame/skin_point.h"

namespace pelage {
namespace {

/// Shadow rays per sample. DirectLight proposes four points per ray, on all lights in turn.
constexpr int kRays = 4;

}  // namespace

ShadowCatcher::ShadowCatcher(const FrameScene& scene, const Accel& accel)
    : accel_(accel), direct_(scene.lights, kRays, DirectTechniques::kLightsOnly) {
  for (const SkinPart& skin : scene.skins) {
    const auto* lambert = std::get_if<LambertParams>(&scene.materials.at(skin.material));
    of_skin_.push_back(lambert && lambert->shadow_catcher);
    any_ = any_ || of_skin_.back();
  }
}

ShadowCatcher::Blocked ShadowCatcher::blocked(const Ray& ray, const Hit& hit, SampleStream& stream,
                                              DirectLightScratch& lights, SampleScratch& scratch) const {
  const SkinPoint at = skin_point(scratch.thread.hit_geometry.triangle, ray, hit);
  // White, whatever the colour of the skin, so that the fraction of each channel is known.
  ScatterPoint point(at.position, at.start, LambertBsdf(Rgb(1), at.normal));
  point.set_part({true, hit.part});
  direct_.begin(point, lights);
  seek(stream, VertexDimension::kLight);
  direct_.propose(
      point, stream.next2d(), [](const FibreValue&) { return 0.0f; }, lights);
  Rgb all(0), lost(0);
  for (const LightPoint& to : lights.points)
    all += to.value.total() * to.arriving * direct_.candidate_weight();
  seek(stream, VertexDimension::kLightChoice);
  direct_.choose(static_cast<float>(kRays), stream.next1d(), lights, [&](const LightPoint& to, float factor) {
    Ray shadow;
    shadow.origin = point.start(to.direction);
    shadow.direction = to.direction;
    shadow.far = to.distance * DirectLight::kJustBefore;
    shadow.time = ray.time;
    shadow.casters = to.casters;
    const float through = scratch.light_through(accel_, shadow);
    lost += to.value.total() * to.arriving * (factor * (1 - through));
  });
  Blocked blocked;
  for (int c = 0; c < 3; ++c) {
    if (all[c] > 0) blocked.fraction[c] = lost[c] / all[c];
  }
  if (luminance(all) > 0) blocked.alpha = std::clamp(luminance(lost) / luminance(all), 0.0f, 1.0f);
  return blocked;
}

}  // namespace pelage
