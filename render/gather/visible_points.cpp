// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/gather/gather_integrator_test.cpp.
#include "render/gather/visible_points.h"

#include <cmath>
#include <limits>

#include "base/hash.h"
#include "render/light/seen_lights.h"

namespace pelage {
namespace {

/// Draws after SampleDraw::kFirstVertex, the same as those of a path's first vertex.
enum FirstVertexDraw : uint32_t { kLight = 0, kLobe = 1, kLightChoice = 4 };

void seek(SampleStream& stream, FirstVertexDraw draw) {
  stream.seek(static_cast<uint32_t>(SampleDraw::kFirstVertex) + draw);
}

/// The i-th number of a sequence in [0, 1) from the random number u: a rotation by the golden ratio.
float turned(float u, size_t i) {
  const float sum = u + static_cast<float>(i) * 0.6180339887f;
  return sum - std::floor(sum);
}

uint32_t index_of(std::unordered_map<uint64_t, uint32_t>& indices, uint64_t key) {
  return indices.try_emplace(key, static_cast<uint32_t>(indices.size())).first->second;
}

}  // namespace

VisiblePoints::VisiblePoints(const RenderScene& scene, const FrameShading& shading,
                             const CameraSamples& camera, uint32_t samples)
    : scene_(scene),
      shading_(shading),
      camera_(camera),
      keys_(scene, samples),
      direct_(scene.lights, scene.render.light_samples, DirectTechniques::kBoth) {}

uint32_t VisiblePoints::knot_of(const KnotKey& key, Scratch& scratch, TileSamples& tile) const {
  // Without reuse, each point has a knot of its own.
  const auto count = static_cast<uint32_t>(tile.zone_of_knot.size());
  const uint32_t knot = scene_.render.gather.reuse ? index_of(scratch.knots, key.knot) : count;
  if (knot < count) return knot;
  tile.zone_of_knot.push_back(index_of(scratch.zones, key.zone));
  tile.zones = static_cast<uint32_t>(scratch.zones.size());
  return knot;
}

void VisiblePoints::look(uint32_t pixel, uint32_t sample, const CameraSample* known, const FindHit& find,
                         Scratch& scratch, SampleScratch& thread, TileSamples& tile) const {
  const int x = tile.x(pixel), y = tile.y(pixel);
  SampleStream stream = camera_.stream(x, y, sample);
  const CameraSample from = known ? *known : camera_.draw(x, y, sample, stream);
  const auto index = static_cast<uint32_t>(tile.samples.size());
  tile.samples.push_back({from.offset, pixel});
  const Hit hit = find(from.ray);
  seen_lights(scene_.lights, from.ray.origin, from.ray.direction, hit.distance,
              [&](size_t light, const Rgb& radiance) {
                tile.seen_lights.push_back({index, static_cast<uint32_t>(light), radiance});
              });
  if (!hit) return;
  tile.samples.back().point = static_cast<uint32_t>(tile.points.size());
  FilmSample film_sample;
  film_sample.offset = from.offset;
  TileSamples::Front& front = tile.fronts[pixel];
  if (front.of_pixel.yields_to(shading_.depth(from.ray, hit), film_sample.inside_pixel())) {
    const VisibleSurface surface = shading_.visible_surface(from.ray, hit, thread.thread.met);
    front.of_pixel.offer(surface, film_sample.inside_pixel());
    front.sample = index;
  }

  const uint64_t random = hash64(random_use("knot"), static_cast<uint64_t>(scene_.render.seed),
                                 static_cast<uint32_t>(x), static_cast<uint32_t>(y), sample);
  const KnotKey key = keys_.of(hit, thread.thread.met, {unit_float(random), unit_float(mix64(random))});
  VisiblePoint visible;
  visible.pixel = pixel;
  visible.sample = sample;
  visible.knot = knot_of(key, scratch, tile);
  visible.time = from.ray.time;
  visible.random = from.ray.random;
  const ScatterPoint point = shading_.scatter_point(from.ray, hit, thread.thread.met);
  if (!point.can_hit_own_strand()) visible.start = hit.start;
  find_light(point, stream, scratch, thread, visible, tile);
  tile.points.push_back(visible);
}

/// Evaluates the light at a visible point as if nothing blocked it, and draws the rays that leave the point.
void VisiblePoints::find_light(const ScatterPoint& point, SampleStream& stream, Scratch& scratch,
                               SampleScratch& thread, VisiblePoint& visible, TileSamples& tile) const {
  const size_t lights = scene_.lights.size();
  const size_t first = tile.unoccluded.size(), first_ray = tile.light_rays.size();
  tile.unoccluded.resize(first + lights * kLobeGroups, Rgb(0));
  seek(stream, kLightChoice);
  const float u = stream.next1d();
  scratch.choices.clear();
  for (size_t i = 0; i < lights; ++i) {
    LightRay& ray = tile.light_rays.emplace_back();
    ray.point = static_cast<uint32_t>(tile.points.size());
    ray.light = static_cast<uint32_t>(i);
    scratch.choices.emplace_back(turned(u, i));
  }
  const auto propose = [&](size_t light, const Rgb* lobes, const Rgb& arriving, const V3f& direction,
                           float distance) {
    Rgb parts[kLobeGroups], total(0);
    for (int g = 0; g < kLobeGroups; ++g) {
      parts[g] = lobes[g] * arriving;
      tile.unoccluded[first + light * kLobeGroups + static_cast<size_t>(g)] += parts[g];
      total += parts[g];
    }
    const float mass = luminance(total);
    if (!scratch.choices[light].takes(mass)) return;
    LightRay& ray = tile.light_rays[first_ray + light];
    ray.ray = {V3f(0), direction, distance * DirectLight::kJustBefore};
    for (int g = 0; g < kLobeGroups; ++g) ray.lobes[g] = parts[g] / mass;
  };

  direct_.begin(point, scratch.direct);
  seek(stream, kLight);
  direct_.propose(
      point, stream.next2d(), [](const FibreValue& value) { return value.pdf; }, scratch.direct);
  thread.costs.occlusion.add_candidates(direct_.candidates(), scratch.direct.proved);
  for (const LightPoint& to : scratch.direct.points) {
    propose(to.light, to.value.lobes, to.arriving * direct_.candidate_weight(), to.direction, to.distance);
  }
  seek(stream, kLobe);
  const auto sample = point.sample(stream.next3d());
  if (sample) {
    const FibreValue& value = sample->value;
    for (int g = 0; g < kLobeGroups; ++g) visible.weights[g] = value.lobes[g] / value.pdf;
    visible.scattered = {point.start(sample->wi), sample->wi, std::numeric_limits<float>::infinity()};
    direct_.find_lights(point, sample->wi, visible.scattered.far, value.pdf, scratch.direct,
                        [&](size_t light, const LightHit& hit, float weight) {
                          if (point.is_shadowed(sample->wi, hit.distance * DirectLight::kJustBefore)) {
                            ++thread.costs.occlusion.rays_proved;
                            return;
                          }
                          propose(light, visible.weights, hit.radiance * weight, sample->wi, hit.distance);
                        });
  }
  size_t kept = first_ray;
  for (size_t i = first_ray; i < tile.light_rays.size(); ++i) {
    LightRay ray = tile.light_rays[i];
    ray.unoccluded = scratch.choices[ray.light].sum();
    if (!(ray.unoccluded > 0)) continue;
    for (Rgb& lobe : ray.lobes) lobe *= ray.unoccluded;
    ray.ray.origin = point.start(ray.ray.direction);
    ray.modelled = point.modelled_light(ray.ray.direction, ray.ray.far).value_or(-1.0f);
    tile.light_rays[kept++] = ray;
  }
  tile.light_rays.resize(kept);
}

}  // namespace pelage
