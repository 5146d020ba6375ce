// SPDX-License-Identifier: Apache-2.0
#include "render/gather/indirect_paths.h"

#include <algorithm>
#include <utility>

#include "base/hash.h"
#include "render/sampling/systematic_choice.h"

namespace pelage {
namespace {

constexpr uint32_t kPathsPerCheck = 256;  // whether to stop

}  // namespace

/// A sink of PathWalk: sums up the light that arrives along the first ray of a path, by source.
class IndirectPaths::ArrivingLight {
 public:
  ArrivingLight(const FrameScene& scene, const ReflectionCache* cache, Scratch& scratch, IndirectClamp& clamp)
      : scene_(scene),
        cache_(cache),
        arriving_(scratch.arriving),
        counts_(scratch.reflections),
        clamp_(clamp) {}

  /// Ends the path at its third surface, after shadow rays, if the cache knows what else this surface
  /// reflects.
  Arrival arrive(const PathState& path, const HitGeometry& hit_geometry) {
    if (!cache_ || path.vertex != ReflectionCache::kVertex) return Arrival::kGoOn;
    const ReflectionSlots::Radiance reflected = cache_->find(path.ray, path.hit, hit_geometry);
    ++counts_.lookups;
    if (!reflected) return Arrival::kGoOn;
    ++counts_.found;
    for (size_t source = 0; source < arriving_.size(); ++source) add(path, source, reflected[source]);
    return Arrival::kShadowRays;
  }

  void shadow(const PathState& path, const LightPoint& from, float factor, float through) {
    if (through > 0)
      add(path, scene_.source(from.light), from.value.total() * from.arriving * (through * factor));
  }
  void hit_light(const PathState& path, size_t light, const Rgb& radiance, float weight, float through) {
    if (weight * through > 0) add(path, scene_.source(light), radiance * (weight * through));
  }

 private:
  void add(const PathState& path, size_t source, const Rgb& light) {
    const Rgb arriving = path.throughput * light;
    arriving_[source] += arriving * clamp_.keep(path.first, arriving);
  }

  const FrameScene& scene_;
  const ReflectionCache* cache_;
  std::vector<Rgb>& arriving_;
  ReflectionStatistics& counts_;
  IndirectClamp& clamp_;
};

bool IndirectPaths::trace(const TileSamples& samples, const Job& job, Scratch& scratch, SampleScratch& thread,
                          PathSharing& light) const {
  if (scene_.render.bounces == 0) return true;
  scratch.order.sort(0, samples.points.size(), samples.zone_of_gather_point.size(),
                     [&](size_t i) { return samples.points[i].gather_point; });
  const double step = scene_.render.gather.reuse ? 1 / double{scene_.render.gather.paths} : 1;
  SystematicChoice choice(step, 0);
  size_t traced = 0;
  uint32_t last = TileSamples::kNoPoint;
  for (const uint32_t index : scratch.order.items()) {
    const VisiblePoint& point = samples.points[index];
    const uint32_t gather_point = point.gather_point;
    if (gather_point != std::exchange(last, gather_point))
      choice =
          SystematicChoice(step, unit_float(hash64(random_use("paths"), samples.random_key, gather_point)));
    light.add_weights(gather_point, point.weights);
    const float mass =
        options_.roulette ? PathWalk<ArrivingLight>::survival(point.weight(), point.attraction) : 1.0f;
    const uint32_t times = choice.times(mass);
    if (times == 0) continue;
    if (++traced % kPathsPerCheck == 0 && job.progress.cancelled()) return false;
    const auto factor = static_cast<float>(times * step / mass);
    follow(samples, point, factor, scratch, thread);
    light.add_path(gather_point, point.weights, factor, scratch.arriving);
  }
  return true;
}

void IndirectPaths::follow(const TileSamples& samples, const VisiblePoint& point, float factor,
                           Scratch& scratch, SampleScratch& thread) const {
  PathState path(camera_.stream(samples.x(point.pixel), samples.y(point.pixel), point.sample));
  path.time = point.time;
  path.random = point.random;
  std::copy(std::begin(point.weights), std::end(point.weights), path.first);
  path.weight = point.weight() * factor;
  path.attraction = point.attraction;
  scratch.arriving.assign(scene_.sources(), Rgb(0));
  ArrivingLight sink(scene_, cache_ ? &*cache_ : nullptr, scratch, thread.clamp);
  walk_.follow(point.ray(point.scattered), path, scratch.direct, thread, sink);
}

}  // namespace pelage
