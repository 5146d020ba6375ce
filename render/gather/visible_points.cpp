// SPDX-License-Identifier: Apache-2.0
#include "render/gather/visible_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/hash.h"
#include "render/light/seen_lights.h"
#include "render/sampling/systematic_choice.h"

namespace pelage {
namespace {

/// The i-th number of a sequence in [0, 1) from the random number u: a rotation by the golden ratio.
float turned(float u, size_t i) {
  const float sum = u + static_cast<float>(i) * 0.6180339887f;
  return sum - std::floor(sum);
}

}  // namespace

VisiblePoints::VisiblePoints(const FrameScene& scene, const Accel& accel, const FrameShading& shading,
                             const CameraSamples& camera, const FarLightSamples& far_lights, uint32_t samples)
    : scene_(scene),
      shading_(shading),
      camera_(camera),
      catcher_(scene, accel),
      keys_(scene, samples),
      direct_(scene.lights, scene.render.light_samples, DirectTechniques::kBoth, &far_lights) {}

/// Finds the indices of the gather point, patch and zone of a visible point.
void VisiblePoints::assign(const GatherPointKey& key, Scratch& scratch, TileSamples& tile,
                           VisiblePoint& visible) const {
  const uint32_t first_zone = scratch.coats.index(key.coat) * kZonesOfCoat;
  const float depth = std::clamp(key.depth, 0.0f, 1.0f) * kZonesOfCoat - 0.5f;
  const float below = std::clamp(std::floor(depth), 0.0f, kZonesOfCoat - 2.0f);
  visible.depth = {first_zone + static_cast<uint32_t>(below), depth - below};
  // Without reuse, each point has a gather point of its own.
  const auto count = static_cast<uint32_t>(tile.zone_of_gather_point.size());
  visible.gather_point = scene_.render.gather.reuse ? scratch.gather_points.index(key.gather_point) : count;
  if (visible.gather_point < count) return;
  tile.zone_of_gather_point.push_back(first_zone + key.zone);
  tile.patch_of_gather_point.push_back(scratch.patches.index(key.patch));
  tile.zones = scratch.coats.size() * kZonesOfCoat;
  tile.patches = scratch.patches.size();
}

void VisiblePoints::add(uint32_t pixel, uint32_t sample, const CameraSample& from, const Hit& hit,
                        Scratch& scratch, SampleScratch& thread, LightSharing& sharing,
                        TileSamples& tile) const {
  const auto index = static_cast<uint32_t>(tile.samples.size());
  tile.samples.push_back({from.offset, pixel});
  const auto see = [&](size_t light, const Rgb& radiance) {
    const auto source = static_cast<uint32_t>(scene_.source(light));
    auto& seen = tile.seen_lights;
    const auto same = std::find_if(seen.rbegin(), seen.rend(), [&](const auto& other) {
      return other.sample != index || other.light == source;
    });
    if (same != seen.rend() && same->sample == index) {
      same->radiance += radiance;
    } else {
      seen.push_back({index, source, radiance});
    }
  };
  const Ray& ray = from.ray;
  seen_lights(scene_.lights, ray.origin, ray.direction, ray.time, hit.distance, see);
  if (!hit) return;
  if (catcher_.is_catcher(hit)) {
    SampleStream stream = camera_.stream(tile.x(pixel), tile.y(pixel), sample);
    const auto blocked = catcher_.blocked(ray, hit, stream, scratch.direct, thread);
    tile.samples.back().alpha = blocked.alpha;
    background_lights(
        scene_.lights, ray.origin, ray.direction, ray.time,
        [&](size_t light, const Rgb& radiance) { see(light, radiance * (Rgb(1) - blocked.fraction)); });
    return;
  }
  tile.samples.back().alpha = 1;
  tile.samples.back().point = static_cast<uint32_t>(tile.points.size());
  FilmSample film_sample;
  film_sample.offset = from.offset;
  TileSamples::Front& front = tile.fronts[pixel];
  if (front.of_pixel.yields_to(shading_.depth(from.ray, hit), film_sample.inside_pixel())) {
    const VisibleSurface surface = shading_.visible_surface(from.ray, hit, thread.thread.hit_geometry);
    front.of_pixel.offer(surface, film_sample.inside_pixel());
    front.sample = index;
  }

  const int x = tile.x(pixel), y = tile.y(pixel);
  const uint64_t random = hash64(random_use("knot"), static_cast<uint64_t>(scene_.render.seed),
                                 static_cast<uint32_t>(x), static_cast<uint32_t>(y), sample);
  const V2f choice(unit_float(random), unit_float(mix64(random)));
  const GatherPointKey key = keys_.of(hit, thread.thread.hit_geometry, choice, scratch.strands);
  VisiblePoint visible;
  visible.pixel = pixel;
  visible.sample = sample;
  assign(key, scratch, tile, visible);
  visible.time = from.ray.time;
  visible.random = from.ray.random;
  const ScatterPoint point = shading_.scatter_point(from.ray, hit, thread.thread.hit_geometry);
  if (!point.can_hit_own_strand()) visible.start = hit.start;
  SampleStream stream = camera_.stream(x, y, sample);
  find_light(point, stream, scratch, thread, visible, tile);
  expect_light(visible, tile.zone_of_gather_point[visible.gather_point], scratch, sharing);
  seek(stream, VertexDimension::kLightChoice);
  choose_targets(point, stream.next1d(), scratch, tile);
  tile.points.push_back(visible);
}

/// Evaluates the light at a visible point as if nothing blocked it, and samples the rays that leave the
/// point.
void VisiblePoints::find_light(const ScatterPoint& point, SampleStream& stream, Scratch& scratch,
                               SampleScratch& thread, VisiblePoint& visible, TileSamples& tile) const {
  const size_t lights = scene_.sources();
  const size_t first = tile.unoccluded.size();
  tile.unoccluded.resize(first + lights * kLobeGroups, Rgb(0));
  scratch.candidates.clear();
  scratch.masses.assign(lights, 0);
  const auto propose = [&](size_t of, const Rgb* lobes, const Rgb& arriving, const V3f& direction,
                           float distance, const PartSet* casters) {
    const size_t light = scene_.source(of);
    Candidate candidate;
    Rgb total(0);
    for (int g = 0; g < kLobeGroups; ++g) {
      candidate.lobes[g] = lobes[g] * arriving;
      tile.unoccluded[first + light * kLobeGroups + static_cast<size_t>(g)] += candidate.lobes[g];
      total += candidate.lobes[g];
    }
    candidate.mass = luminance(total);
    if (!(candidate.mass > 0)) return;
    candidate.light = static_cast<uint32_t>(light);
    candidate.direction = direction;
    candidate.far = distance * DirectLight::kJustBefore;
    candidate.casters = casters;
    scratch.candidates.push_back(candidate);
  };

  direct_.begin(point, scratch.direct);
  seek(stream, VertexDimension::kLight);
  direct_.propose(
      point, stream.next2d(), [](const FibreValue& value) { return value.pdf; }, scratch.direct);
  thread.costs.occlusion.add_candidates(direct_.candidates(), scratch.direct.proved);
  for (const LightPoint& to : scratch.direct.points) {
    propose(to.light, to.value.lobes, to.arriving * direct_.candidate_weight(), to.direction, to.distance,
            to.casters);
  }
  seek(stream, VertexDimension::kLobe);
  const auto sample = point.sample(stream.next3d());
  if (sample) {
    const FibreValue& value = sample->value;
    for (int g = 0; g < kLobeGroups; ++g) visible.weights[g] = value.lobes[g] / value.pdf;
    visible.attraction = value.attraction;
    visible.scattered = {point.start(sample->wi), sample->wi, std::numeric_limits<float>::infinity()};
    direct_.find_lights(point, sample->wi, visible.scattered.far, value.pdf, scratch.direct,
                        [&](size_t light, const LightHit& hit, float weight) {
                          if (point.is_shadowed(sample->wi, hit.distance * DirectLight::kJustBefore)) {
                            ++thread.costs.occlusion.rays_proved;
                            return;
                          }
                          propose(light, visible.weights, hit.radiance * weight, sample->wi, hit.distance,
                                  nullptr);
                        });
  }
}

/// Finds out what is known about the candidates, and adds the light that is expected of them.
void VisiblePoints::expect_light(const VisiblePoint& visible, uint32_t zone, Scratch& scratch,
                                 LightSharing& sharing) const {
  const ArrivalGuess& guess = sharing.guess();
  for (Candidate& candidate : scratch.candidates) {
    const uint32_t range = ArrivalGuess::range_of(candidate.direction);
    const size_t group = scene_.group(candidate.light);
    candidate.deviation = guess.deviation(zone, group, range);
    scratch.masses[candidate.light] += candidate.mass * candidate.deviation;
    if (!scene_.render.gather.reuse) continue;
    const float fraction = guess.fraction(zone, group, range);
    if (fraction > 0) sharing.add_arriving(visible.gather_point, candidate.light, candidate.lobes, fraction);
  }
}

/// Chooses the targets of shadow rays among the candidates of the point, and adds the rays to the tile.
void VisiblePoints::choose_targets(const ScatterPoint& point, float u, Scratch& scratch,
                                   TileSamples& tile) const {
  const uint32_t targets = TileSamples::targets(scratch.masses.size());
  for (size_t light = 0; light < scratch.masses.size(); ++light) {
    if (!(scratch.masses[light] > 0)) continue;
    SystematicChoice choice(double{scratch.masses[light]} / targets, turned(u, light));
    for (const Candidate& candidate : scratch.candidates) {
      if (candidate.light != light) continue;
      const uint32_t times = choice.times(candidate.mass * candidate.deviation);
      if (times == 0) continue;
      LightRay& ray = tile.light_rays.emplace_back();
      ray.point = static_cast<uint32_t>(tile.points.size());
      ray.light = candidate.light;
      ray.unoccluded = static_cast<float>(times * choice.step()) / candidate.deviation;
      for (int g = 0; g < kLobeGroups; ++g)
        ray.lobes[g] = candidate.lobes[g] * (ray.unoccluded / candidate.mass);
      ray.ray = {point.start(candidate.direction), candidate.direction, candidate.far, candidate.casters};
    }
  }
}

}  // namespace pelage
