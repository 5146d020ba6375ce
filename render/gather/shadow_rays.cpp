// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/gather/gather_integrator_test.cpp.
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

}  // namespace

/// Adds the unoccluded light of the rays from `first` on, and sums up the light that is expected of each
/// pixel. Returns the sum over all pixels.
double ShadowRays::add_unoccluded(const TileSamples& samples, size_t first, Scratch& scratch,
                                  LightSharing& light) const {
  scratch.pixel_light.assign(samples.pixels(), 0);
  double sum = 0;
  for (size_t i = first; i < samples.light_rays.size(); ++i) {
    const LightRay& ray = samples.light_rays[i];
    const VisiblePoint& point = samples.points[ray.point];
    const size_t lobes = (ray.point * scene_.lights.size() + ray.light) * kLobeGroups;
    light.add_unoccluded(point.knot, ray.light, &samples.unoccluded[lobes]);
    const double expected = ray.unoccluded * light.chance(samples.zone(point), ray.light);
    scratch.pixel_light[point.pixel] += expected;
    sum += expected;
  }
  return sum;
}

/// Computes the mass of each ray in the order of `scratch.order`: the standard deviation of the light that
/// arrives along it. For light that arrives with a small probability p, the deviation is proportional to
/// sqrt(p). With reuse, the mass is relative to the light of the pixel; without reuse, to the masses of all
/// rays of the point. Returns the sum of all masses.
double ShadowRays::weigh(const TileSamples& samples, double darkest, const LightSharing& light,
                         Scratch& scratch) const {
  const std::span<const uint32_t> order = scratch.order.items();
  const bool reuse = scene_.render.gather.reuse;
  scratch.masses.resize(order.size());
  double sum = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    const LightRay& ray = samples.light_rays[order[i]];
    const VisiblePoint& point = samples.points[ray.point];
    const float deviation = ray.unoccluded * std::sqrt(light.chance(samples.zone(point), ray.light));
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
  const double tile_light = add_unoccluded(samples, first, scratch, light);
  const size_t lights = scene_.lights.size(), knots = samples.zone_of_knot.size();
  scratch.order.sort(first, count, knots * lights, [&](size_t i) {
    const LightRay& ray = samples.light_rays[i];
    return samples.points[ray.point].knot * lights + ray.light;
  });
  const double darkest = kDarkest * tile_light / static_cast<double>(samples.pixels());
  const double mass = weigh(samples, darkest, light, scratch);
  const size_t points = samples.points.size() - samples.light_rays[first].point;
  const double rays = scene_.render.gather.reuse
                          ? double{scene_.render.gather.light_rays} * static_cast<double>(points)
                          : mass * (scene_.render.light_samples + 1);
  size_t traced = 0;
  const float* masses = scratch.masses.data();
  for (uint32_t knot = 0; knot < knots; ++knot) {
    const std::span<const uint32_t> items = scratch.order.groups(knot * lights, lights);
    if (items.empty()) continue;
    // Knots choose independently: which rays one knot traces says nothing about the choice of another.
    const uint64_t random = hash64(random_use("shadow rays"), samples.random_key, first > 0 ? 1 : 0, knot);
    SystematicChoice choice(mass / rays, unit_float(random));
    for (const uint32_t index : items) {
      const float of_ray = *masses++;
      const uint32_t times = choice.times(of_ray);
      if (times == 0) continue;
      if (++traced % kRaysPerCheck == 0 && job.progress.cancelled()) return false;
      const LightRay& ray = samples.light_rays[index];
      const VisiblePoint& point = samples.points[ray.point];
      const bool is_modelled = ray.modelled >= 0;
      thread.costs.occlusion.rays_modelled += is_modelled ? 1 : 0;
      const float through = is_modelled ? ray.modelled : thread.light_through(accel_, point.ray(ray.ray));
      const auto factor = static_cast<float>(times * choice.step() / of_ray);
      light.add_ray(knot, samples.zone(point), ray.light, ray.lobes, factor, through);
    }
  }
  return true;
}

}  // namespace pelage
