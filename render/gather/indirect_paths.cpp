// SPDX-License-Identifier: Apache-2.0
#include "render/gather/indirect_paths.h"

#include <algorithm>
#include <span>
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
  if (!trace_paths(samples, job, scratch, thread, light.profile())) return false;
  if (scene_.render.gather.reuse) light.profile().learn();
  Rgb weights[kLobeGroups];
  const auto weigh = [&](const VisiblePoint& point) {
    const float expected = light.profile().at(point.depth, 0);
    for (int g = 0; g < kLobeGroups; ++g) weights[g] = point.weights[g] * expected;
    return expected;
  };
  for (const VisiblePoint& point : samples.points) {
    weigh(point);
    light.add_weights(point.gather_point, weights);
  }
  Rgb* arrived = scratch.arrived.data();
  for (const auto& [index, factor] : scratch.traced) {
    const VisiblePoint& point = samples.points[index];
    const float expected = weigh(point);
    const std::span<Rgb> radiance(arrived, scene_.sources());
    for (Rgb& of_light : radiance) of_light /= expected;
    light.add_path(point.gather_point, weights, factor, radiance);
    arrived += scene_.sources();
  }
  return true;
}

/// Fills `scratch.traced` and `scratch.arrived`, and adds the paths to `profile`. Returns false when `job`
/// was cancelled.
bool IndirectPaths::trace_paths(const TileSamples& samples, const Job& job, Scratch& scratch,
                                SampleScratch& thread, DepthProfile& profile) const {
  scratch.order.sort(0, samples.points.size(), samples.zone_of_gather_point.size(),
                     [&](size_t i) { return samples.points[i].gather_point; });
  scratch.traced.clear();
  scratch.arrived.clear();
  const double step = scene_.render.gather.reuse ? 1 / double{scene_.render.gather.paths} : 1;
  SystematicChoice choice(step, 0);
  uint32_t last = TileSamples::kNoPoint;
  for (const uint32_t index : scratch.order.items()) {
    const VisiblePoint& point = samples.points[index];
    const uint32_t gather_point = point.gather_point;
    if (gather_point != std::exchange(last, gather_point))
      choice =
          SystematicChoice(step, unit_float(hash64(random_use("paths"), samples.random_key, gather_point)));
    const float mass =
        options_.roulette ? PathWalk<ArrivingLight>::survival(point.weight(), point.attraction) : 1.0f;
    const uint32_t times = choice.times(mass);
    if (times == 0) continue;
    if (scratch.traced.size() % kPathsPerCheck == 0 && job.progress.cancelled()) return false;
    const auto factor = static_cast<float>(times * step / mass);
    follow(samples, point, factor, scratch, thread);
    scratch.traced.push_back({index, factor});
    scratch.arrived.insert(scratch.arrived.end(), scratch.arriving.begin(), scratch.arriving.end());
    if (!scene_.render.gather.reuse) continue;
    Rgb all(0);
    for (const Rgb& of_light : scratch.arriving) all += of_light;
    const Rgb weight = point.weight();
    profile.add(gather_point, point.depth, 0, double{luminance(weight)} * factor,
                double{luminance(weight * all)} * factor);
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
