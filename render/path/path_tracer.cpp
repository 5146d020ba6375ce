// SPDX-License-Identifier: Apache-2.0
// Tested in tests/render/path/path_furnace_test.cpp.
#include "render/path/path_tracer.h"

#include <algorithm>
#include <cmath>

namespace pelage {
namespace {

/// Draws of a sample (see SampleStream): places that stay the same whatever a path does.
enum Draw : uint32_t { kFilm = 0, kLens = 1, kTime = 2, kFirstVertex = 3 };
enum VertexDraw : uint32_t { kLight = 0, kLobe = 1, kRoulette = 3, kLightChoice = 4, kVertexDraws = 5 };
/// Of the light about it, what a surface shows: roughly, pale fur less than skin.
constexpr float kShown = 0.5f;

/// How likely roulette lets a path go on that has this weight: what it may still bring, over what the pixel
/// shows [Vorba16]. By the weight alone, paths would end that bring as much as others: in pale fur a quarter
/// fewer rays, and two thirds more variance.
float survival(const Rgb& weight) { return std::min(1.0f, max_component(weight) / kShown); }

}  // namespace

struct PathTracer::Scratch final : SampleScratch {
  DirectLightScratch direct;
};

/// The state of a path at its current vertex.
struct PathTracer::Path {
  Path(const FilmLayers& film_layers, const SampleStream& numbers, Scratch& memory)
      : layers(film_layers), stream(numbers), scratch(memory) {}

  void seek(uint32_t draw) { stream.seek(kFirstVertex + kVertexDraws * vertex + draw); }

  /// Adds light that reaches the camera through lobe group g of the first surface as lobes[g] * light.
  void add(size_t source, const Rgb* lobes, const Rgb& light) {
    const float kept = vertex > 0 ? scratch.clamp.keep(lobes, light) : 1;
    Rgb total(0);
    for (int g = 0; g < kLobeGroups; ++g) {
      const Rgb part = lobes[g] * light * kept;
      total += part;
      if (g < layers.groups) scratch.by_layer[layers.scattered(source, g)] += part;
    }
    scratch.sample.radiance += total;
  }
  /// Light arriving at the current vertex from a direction whose scattering is `value`.
  void add_scattered(size_t source, const FibreValue& value, const Rgb& light) {
    if (vertex == 0) {
      add(source, value.lobes, light);
    } else {
      add(source, first, throughput * value.total() * light);
    }
  }

  const FilmLayers& layers;
  SampleStream stream;
  Scratch& scratch;
  uint32_t vertex = 0;
  uint32_t random = 0;  // decides at semi-transparent crossings
  float time = 0;
  Ray ray;  // that led to `hit`
  Hit hit;
  Rgb first[kLobeGroups];  // rho / pdf of the first vertex, by lobe group
  Rgb throughput{1};       // of the vertices after the first
  Rgb weight{1};           // of all vertices before this one
};

PathTracer::PathTracer(const RenderScene& scene, const Accel& accel, const FilmLayers& layers,
                       const PathOptions& options)
    : scene_(scene),
      accel_(accel),
      layers_(layers),
      options_(options),
      direct_(scene.lights, scene.render.light_samples, options.direct),
      shading_(scene),
      filter_(scene.image.filter) {}

Ray PathTracer::camera_ray(int x, int y, SampleStream& stream, Scratch& scratch) const {
  stream.seek(kFilm);
  const V2f offset = filter_.offset(stream.next2d());
  V2f lens(0.5f);
  float time = 0;
  if (scene_.camera.has_lens()) {
    stream.seek(kLens);
    lens = stream.next2d();
  }
  if (scene_.camera.shutter_frames() > 0) {
    stream.seek(kTime);
    time = stream.next1d();
  }
  scratch.sample.inside_pixel = std::max(std::abs(offset.x), std::abs(offset.y)) <= 0.5f;
  const CameraRay from = scene_.camera.ray(static_cast<float>(x) + 0.5f + offset.x,
                                           static_cast<float>(y) + 0.5f + offset.y, lens, time);
  Ray ray;
  ray.origin = from.origin;
  ray.direction = from.direction;
  ray.time = from.time;
  return ray;
}

/// Lights that the camera sees directly, in front of `distance`.
void PathTracer::see_lights(const Ray& ray, float distance, Scratch& scratch) const {
  for (size_t i = 0; i < scene_.lights.size(); ++i) {
    const Light& light = scene_.lights.light(i);
    if (!light.visible()) continue;
    const auto hit = light.intersect(ray.origin, ray.direction);
    if (!hit || hit->distance > distance) continue;
    scratch.sample.radiance += hit->radiance;
    if (!layers_.empty()) scratch.by_layer[layers_.emitted(i)] += hit->radiance;
  }
}

void PathTracer::sample_lights(const ScatterPoint& point, Path& path) const {
  DirectLightScratch& scratch = path.scratch.direct;
  path.seek(kLight);
  const auto lobe_pdf = [&](const FibreValue& value) { return arriving_pdf(value, path); };
  const double total = direct_.propose(point, path.stream.next2d(), lobe_pdf, scratch);
  if (!(total > 0)) return;
  path.seek(kLightChoice);
  direct_.choose(total, path.stream.next1d(), scratch,
                 [&](const LightPoint& to, float factor) { shadow_ray(point, to, factor, path); });
}

bool PathTracer::is_last(const Path& path) const {
  return path.vertex == static_cast<uint32_t>(scene_.render.bounces);
}

/// The density with which sample_lobes() arrives at a light in a direction: that of the lobes, and what
/// roulette leaves of it. Without the latter, what a dark surface scatters of a light would be left to a few
/// rays of great weight.
float PathTracer::arriving_pdf(const FibreValue& value, const Path& path) const {
  if (!options_.roulette || is_last(path) || !(value.pdf > 0)) return value.pdf;
  return value.pdf * survival(path.weight * (value.total() / value.pdf));
}

void PathTracer::shadow_ray(const ScatterPoint& point, const LightPoint& to, float factor, Path& path) const {
  Ray ray;
  ray.origin = point.start(to.direction);
  ray.direction = to.direction;
  ray.far = to.distance * DirectLight::kJustBefore;
  ray.time = path.time;
  if (!point.can_hit_own_strand()) ray.start = path.hit.start;
  ++path.scratch.rays.shadow;
  const float through = accel_.transmittance(ray, path.scratch.thread);
  if (through > 0) path.add_scattered(to.light, to.value, to.arriving * (through * factor));
}

/// Lights along a ray drawn from the lobes of the current vertex `point`, in front of `distance`. With
/// `shadowed`, what lies between has yet to be found out.
void PathTracer::gather_lights(const ScatterPoint& point, const Ray& ray, float distance, float lobe_pdf,
                               bool shadowed, Path& path) const {
  direct_.find_lights(point, ray.direction, distance, lobe_pdf, path.scratch.direct,
                      [&](size_t light, const LightHit& hit, float weight) {
                        if (shadowed) {
                          Ray shadow = ray;
                          shadow.far = hit.distance * DirectLight::kJustBefore;
                          ++path.scratch.rays.shadow;
                          weight *= accel_.transmittance(shadow, path.scratch.thread);
                        }
                        if (weight > 0) path.add(light, path.first, path.throughput * hit.radiance * weight);
                      });
}

/// Follows a direction drawn from the lobes to the next vertex. Returns false where the path ends.
bool PathTracer::sample_lobes(const ScatterPoint& point, Path& path) const {
  const bool last = is_last(path);
  if (last && options_.direct == DirectTechniques::kLightsOnly) return false;
  path.seek(kLobe);
  const auto sample = point.sample(path.stream.next3d());
  if (!sample) return false;
  const FibreValue& value = sample->value;
  if (path.vertex == 0) {
    for (int g = 0; g < kLobeGroups; ++g) path.first[g] = value.lobes[g] / value.pdf;
  } else {
    path.throughput *= value.total() / value.pdf;
  }
  path.weight *= value.total() / value.pdf;
  if (!(max_component(path.weight) > 0)) return false;

  Ray ray;
  ray.origin = point.start(sample->wi);
  ray.direction = sample->wi;
  ray.time = path.time;
  if (!point.can_hit_own_strand()) ray.start = path.hit.start;
  if (last) {
    gather_lights(point, ray, ray.far, value.pdf, true, path);
    return false;
  }
  float survived = 1;
  if (options_.roulette) {
    survived = survival(path.weight);
    path.seek(kRoulette);
    if (path.stream.next1d() >= survived) return false;
    path.throughput /= survived;
    path.weight /= survived;
  }
  ray.random = ++path.random;
  ++path.scratch.rays.indirect;
  const Hit hit = accel_.closest(ray, path.scratch.thread);
  if (options_.direct != DirectTechniques::kLightsOnly) {
    gather_lights(point, ray, hit.distance, value.pdf * survived, false, path);
  }
  path.ray = ray;
  path.hit = hit;
  return static_cast<bool>(hit);
}

std::unique_ptr<SampleScratch> PathTracer::make_scratch() const { return std::make_unique<Scratch>(); }

void PathTracer::trace(int x, int y, uint32_t sample, SampleScratch& memory) const {
  auto& scratch = static_cast<Scratch&>(memory);
  scratch.sample = FilmSample{};
  scratch.clamp.limit = scene_.render.clamp_indirect;
  scratch.by_layer.assign(layers_.size(), Rgb(0));

  const auto seed = static_cast<uint64_t>(scene_.render.seed);
  const auto px = static_cast<uint32_t>(x), py = static_cast<uint32_t>(y);
  Path path(layers_, SampleStream(seed, px, py, sample), scratch);
  path.ray = camera_ray(x, y, path.stream, scratch);
  path.time = path.ray.time;
  if (!accel_.opaque()) {
    path.random = static_cast<uint32_t>(hash64(seed, px, py, sample, random_use("crossings")));
    path.ray.random = path.random;
  }
  ++scratch.rays.camera;
  path.hit = accel_.closest(path.ray, scratch.thread);
  see_lights(path.ray, path.hit.distance, scratch);
  if (!path.hit) return;
  scratch.sample.alpha = 1;
  scratch.sample.surface = shading_.visible_surface(path.ray, path.hit, scratch.thread.met);

  for (;; ++path.vertex) {
    const ScatterPoint point = shading_.scatter_point(path.ray, path.hit, scratch.thread.met);
    direct_.begin(point, scratch.direct);
    if (options_.direct != DirectTechniques::kLobesOnly) sample_lights(point, path);
    if (!sample_lobes(point, path)) return;
  }
}

}  // namespace pelage
