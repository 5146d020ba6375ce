// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/gather/gather_integrator_test.cpp.
#include "render/gather/shadow_rays.h"

#include <cmath>

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

/// Computes the mass of each ray in `scratch.order`: the standard deviation of the light that arrives along
/// it, relative to the light of the pixel. For light that arrives with a small probability p, the deviation
/// is proportional to sqrt(p). Returns the sum of all masses.
double ShadowRays::weigh(const TileSamples& samples, double darkest, const LightSharing& light,
                         Scratch& scratch) const {
  scratch.masses.clear();
  double sum = 0;
  for (const KnotItem& item : scratch.order) {
    const LightRay& ray = samples.light_rays[item.index];
    const VisiblePoint& point = samples.points[ray.point];
    float mass = 1;
    if (scene_.render.gather.reuse) {
      const float deviation = ray.unoccluded * std::sqrt(light.chance(samples.zone(point), ray.light));
      mass = static_cast<float>(deviation / (scratch.pixel_light[point.pixel] + darkest));
    }
    scratch.masses.push_back(mass);
    sum += mass;
  }
  return sum;
}

bool ShadowRays::trace(const TileSamples& samples, size_t first, const Job& job, Scratch& scratch,
                       SampleScratch& thread, LightSharing& light) const {
  if (first == samples.light_rays.size()) return true;
  const double tile_light = add_unoccluded(samples, first, scratch, light);
  const auto item = [&](size_t i) {
    const LightRay& ray = samples.light_rays[i];
    return KnotItem{samples.points[ray.point].knot, ray.light, static_cast<uint32_t>(i)};
  };
  sort_by_knot(first, samples.light_rays.size(), item, scratch.order);
  const double darkest = kDarkest * tile_light / static_cast<double>(samples.pixels());
  const double mass = weigh(samples, darkest, light, scratch);
  const size_t points = samples.points.size() - samples.light_rays[first].point;
  const double rays = scene_.render.gather.reuse
                          ? double{scene_.render.gather.light_rays} * static_cast<double>(points)
                          : mass;
  // Each knot makes its choice by itself, so that the rays of other knots tell nothing about its own.
  SystematicChoice choice(mass / rays, 0);
  size_t traced = 0;
  for (size_t i = 0; i < scratch.order.size(); ++i) {
    const uint32_t knot = scratch.order[i].knot;
    if (i == 0 || knot != scratch.order[i - 1].knot) {
      const uint64_t random = hash64(random_use("shadow rays"), samples.random_key, first > 0 ? 1 : 0, knot);
      choice = SystematicChoice(mass / rays, unit_float(random));
    }
    const uint32_t times = choice.times(scratch.masses[i]);
    if (times == 0) continue;
    if (++traced % kRaysPerCheck == 0 && job.progress.cancelled()) return false;
    const LightRay& ray = samples.light_rays[scratch.order[i].index];
    const VisiblePoint& point = samples.points[ray.point];
    const float through = thread.light_through(accel_, point.ray(ray.ray));
    const auto factor = static_cast<float>(times * choice.step() / scratch.masses[i]);
    light.add_ray(knot, samples.zone(point), ray.light, ray.lobes, factor, through);
  }
  return true;
}

}  // namespace pelage
