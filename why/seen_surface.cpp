// SPDX-License-Identifier: Apache-2.0
#include "why/seen_surface.h"

#include <algorithm>
#include <map>
#include <utility>

#include "render/accel/flush_denormals.h"
#include "render/film/film.h"
#include "render/frame/camera_samples.h"
#include "render/frame/frame_shading.h"

namespace pelage {
namespace {

SeenCount count_of(const RenderScene& scene, const Hit& hit) {
  if (hit.kind == HitKind::kStrand) return {scene.fur[hit.part].name, hit.strand_id};
  if (hit.kind == HitKind::kSkin) return {scene.skins[hit.part].name, {}};
  return {};
}

}  // namespace

SeenSurfaces find_seen_surfaces(const RenderScene& scene, const Accel& accel, bool splatted, int x, int y,
                                uint32_t samples) {
  const FlushDenormals flush;
  const CameraSamples camera(scene, accel, splatted);
  const FrameShading shading(scene);
  TraceThread thread;
  FrontSurface front;
  SeenSurfaces seen;
  std::map<std::pair<std::string, std::optional<uint64_t>>, uint32_t> counts;
  for (uint32_t i = 0; i < samples; ++i) {
    SampleStream stream = camera.stream(x, y, i);
    const CameraSample from = camera.sample(x, y, i, stream);
    const Hit hit = accel.closest(from.ray, thread);
    const SeenCount what = count_of(scene, hit);
    ++counts[{what.name, what.strand}];
    FilmSample sample;
    sample.offset = from.offset;
    if (hit) sample.surface.depth = shading.depth(from.ray, hit);
    if (!front.offer(sample.surface, sample.inside_pixel())) continue;
    seen.front.reset();
    if (hit) seen.front = SeenSurface{from.ray, hit, thread.hit_geometry};
  }
  for (const auto& [what, count] : counts) seen.counts.push_back({what.first, what.second, count});
  std::stable_sort(seen.counts.begin(), seen.counts.end(),
                   [](const SeenCount& a, const SeenCount& b) { return a.samples > b.samples; });
  return seen;
}

}  // namespace pelage
