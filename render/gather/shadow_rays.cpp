// SPDX-License-Identifier: Apache-2.0
#include "render/gather/shadow_rays.h"

#include <cmath>
#include <span>

#include "base/hash.h"
#include "render/sampling/systematic_choice.h"

namespace pelage {
namespace {

/// Errors of a pixel count relative to its light plus this fraction of the mean light of the tile's pixels.
constexpr double kDarkest = 0.1;
constexpr uint32_t kRaysPerCheck = 256;  // whether to stop

/// Guess of the fraction of light that arrives along a ray. Never so small that a pixel gets too few rays.
float chance(const FrameScene& scene, const TileSamples& samples, const LightRay& ray,
             const ArrivalGuess& guess) {
  constexpr float kLeast = 0.02f;
  const uint32_t zone = samples.zone(samples.points[ray.point]);
  return std::max(guess.fraction(zone, scene.group(ray.light), ArrivalGuess::range_of(ray.ray.direction)),
                  kLeast);
}

}  // namespace

/// Sums up the light that is expected of each pixel from the rays from `first` on. Returns the sum over all
/// pixels.
double ShadowRays::expect(const TileSamples& samples, size_t first, const ArrivalGuess& guess,
                          Scratch& scratch) const {
  scratch.pixel_light.assign(samples.pixels(), 0);
  double sum = 0;
  for (size_t i = first; i < samples.light_rays.size(); ++i) {
    const LightRay& ray = samples.light_rays[i];
    const double expected = ray.unoccluded * chance(scene_, samples, ray, guess);
    scratch.pixel_light[samples.points[ray.point].pixel] += expected;
    sum += expected;
  }
  return sum;
}

/// Computes the mass of each ray in the order of `scratch.order`: the standard deviation of the light that
/// arrives along it. With reuse, the mass is relative to the light of the pixel; without reuse, to the masses
/// of all rays of the point. Returns the sum of all masses.
double ShadowRays::weigh(const TileSamples& samples, double darkest, const ArrivalGuess& guess,
                         Scratch& scratch) const {
  const std::span<const uint32_t> order = scratch.order.items();
  const bool reuse = scene_.render.gather.reuse;
  scratch.masses.resize(order.size());
  double sum = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    const LightRay& ray = samples.light_rays[order[i]];
    const VisiblePoint& point = samples.points[ray.point];
    const float deviation = ray.unoccluded * guess.deviation(samples.zone(point), scene_.group(ray.light),
                                                             ArrivalGuess::range_of(ray.ray.direction));
    const double unit = reuse ? scratch.pixel_light[point.pixel] + darkest : 1;
    scratch.masses[i] = static_cast<float>(deviation / unit);
    sum += scratch.masses[i];
  }
  if (reuse) return sum;
  sum = 0;
  for (size_t i = 0, end = 0; i < order.size(); i = end) {
    const uint32_t point = samples.light_rays[order[i]].point;
    float all = 0;
    for (end = i; end < order.size() && samples.light_rays[order[end]].point == point; ++end)
      all += scratch.masses[end];
    for (size_t k = i; k < end; ++k) scratch.masses[k] /= all;
    ++sum;
  }
  return sum;
}

bool ShadowRays::trace(const TileSamples& samples, size_t first, const Job& job, Scratch& scratch,
                       SampleScratch& thread, LightSharing& light) const {
  const size_t count = samples.light_rays.size() - first;
  if (count == 0) return true;
  const double tile_light = expect(samples, first, light.guess(), scratch);
  const size_t lights = scene_.sources(), gather_points = samples.zone_of_gather_point.size();
  scratch.order.sort(first, count, gather_points * lights, [&](size_t i) {
    const LightRay& ray = samples.light_rays[i];
    return samples.points[ray.point].gather_point * lights + ray.light;
  });
  const double darkest = kDarkest * tile_light / static_cast<double>(samples.pixels());
  const double mass = weigh(samples, darkest, light.guess(), scratch);
  const size_t points = samples.points.size() - samples.light_rays[first].point;
  const double rays = scene_.render.gather.reuse
                          ? double{scene_.render.gather.light_rays} * static_cast<double>(points)
                          : mass * (scene_.render.light_samples + 1);
  size_t traced = 0;
  scratch.pilots.clear();
  const float* masses = scratch.masses.data();
  for (uint32_t gather_point = 0; gather_point < gather_points; ++gather_point) {
    const std::span<const uint32_t> items = scratch.order.groups(gather_point * lights, lights);
    if (items.empty()) continue;
    // Gather points choose independently: the rays of one say nothing about the rays of another.
    const uint64_t random =
        hash64(random_use("shadow rays"), samples.random_key, first > 0 ? 1 : 0, gather_point);
    SystematicChoice choice(mass / rays, unit_float(random));
    for (const uint32_t index : items) {
      const float of_ray = *masses++;
      const uint32_t times = choice.times(of_ray);
      if (times == 0) continue;
      if (++traced % kRaysPerCheck == 0 && job.progress.cancelled()) return false;
      const LightRay& ray = samples.light_rays[index];
      const VisiblePoint& point = samples.points[ray.point];
      const float through = thread.light_through(accel_, point.ray(ray.ray));
      const auto factor = static_cast<float>(times * choice.step() / of_ray);
      if (guesses_) {
        const double seen = double{ray.unoccluded} * factor;
        light.profile().add(gather_point, point.depth, scene_.group(ray.light), seen, seen * through);
      }
      if (first == 0) {
        scratch.pilots.push_back({index, factor, through});
        continue;
      }
      const uint32_t zone = samples.zone(point);
      const uint32_t range = ArrivalGuess::range_of(ray.ray.direction);
      const float expected = guesses_ ? light.guess().fraction(zone, scene_.group(ray.light), range) : 0.0f;
      light.add_arriving(gather_point, ray.light, ray.lobes, factor * (through - expected));
    }
  }
  if (first == 0) finish_pilot(samples, scratch, light);
  return true;
}

/// Learns from the pilot's rays, and adds their light. The guess for a gather point must not depend on its
/// own rays.
void ShadowRays::finish_pilot(const TileSamples& samples, Scratch& scratch, LightSharing& light) const {
  ArrivalGuess& guess = light.guess();
  const size_t lights = scene_.sources();
  const auto& pilots = scratch.pilots;
  const auto gather_point_of = [&](uint32_t ray) {
    return samples.points[samples.light_rays[ray].point].gather_point;
  };
  const auto add = [&](const Pilot& pilot, const auto& to) {
    const LightRay& ray = samples.light_rays[pilot.ray];
    to(ray, ArrivalGuess::range_of(ray.ray.direction), double{ray.unoccluded} * pilot.factor);
  };
  for (const Pilot& pilot : pilots) {
    add(pilot, [&](const LightRay& ray, uint32_t range, double luminance) {
      guess.add(samples.zone(samples.points[ray.point]), scene_.group(ray.light), range, luminance,
                pilot.through);
    });
  }
  constexpr size_t kAll = ArrivalGuess::kRanges;  // index of the sums over all ranges
  const auto own = [&](size_t light_index, size_t range) -> ArrivalGuess::Sums& {
    return scratch.own[scene_.group(light_index) * (kAll + 1) + range];
  };
  size_t next = 0;
  for (uint32_t gather_point = 0; gather_point < samples.zone_of_gather_point.size(); ++gather_point) {
    const std::span<const uint32_t> items = scratch.order.groups(gather_point * lights, lights);
    if (items.empty()) continue;
    const size_t begin = next;
    scratch.own.assign(scene_.lights.groups() * (kAll + 1), {});
    for (; next < pilots.size() && gather_point_of(pilots[next].ray) == gather_point; ++next) {
      add(pilots[next], [&](const LightRay& ray, uint32_t range, double luminance) {
        own(ray.light, range).add(luminance, pilots[next].through);
        own(ray.light, kAll).add(luminance, pilots[next].through);
      });
    }
    const auto expected = [&](const LightRay& ray) {
      const uint32_t range = ArrivalGuess::range_of(ray.ray.direction);
      return guesses_
                 ? guess.fraction_without(samples.zone_of_gather_point[gather_point], scene_.group(ray.light),
                                          range, own(ray.light, range), own(ray.light, kAll))
                 : 0.0f;
    };
    for (const uint32_t index : items) {
      const LightRay& ray = samples.light_rays[index];
      light.add_arriving(gather_point, ray.light, ray.lobes, expected(ray));
    }
    for (size_t i = begin; i < next; ++i) {
      const LightRay& ray = samples.light_rays[pilots[i].ray];
      light.add_arriving(gather_point, ray.light, ray.lobes,
                         pilots[i].factor * (pilots[i].through - expected(ray)));
    }
  }
  guess.learn(scene_.render.gather.reject);
}

}  // namespace pelage
