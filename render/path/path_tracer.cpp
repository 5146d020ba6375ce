// SPDX-License-Identifier: Apache-2.0
#include "render/path/path_tracer.h"

#include <algorithm>
#include <cmath>

#include "render/light/mis.h"

namespace pelage {
namespace {

/// Draws of a sample (see SampleStream): places that stay the same whatever a path does.
enum Draw : uint32_t { kFilm = 0, kLens = 1, kTime = 2, kFirstVertex = 3 };
enum VertexDraw : uint32_t { kLight = 0, kLobe = 1, kRoulette = 3, kLightChoice = 4, kVertexDraws = 5 };
/// Points on lights among which one shadow ray chooses.
constexpr uint32_t kCandidates = 4;
constexpr float kGolden = 0.6180339887f;

/// Shadow rays end a little before the light, so that a surface on which a light lies does not block it.
constexpr float kJustBefore = 1 - 1e-4f;

float largest(const Rgb& c) { return std::max({c.x, c.y, c.z}); }

/// Of the light about it, what a surface shows: roughly, pale fur less than skin.
constexpr float kShown = 0.5f;

/// How likely roulette lets a path go on that has this weight: what it may still bring, over what the pixel
/// shows [Vorba16]. By the weight alone, paths would end that bring as much as others: in pale fur a quarter
/// fewer rays, and two thirds more variance.
float survival(const Rgb& weight) { return std::min(1.0f, largest(weight) / kShown); }

}  // namespace

/// The state of a path at its current vertex.
struct PathTracer::Path {
  Path(const FilmLayers& film_layers, const SampleStream& numbers, PathScratch& memory)
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
  PathScratch& scratch;
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
      shading_(scene),
      filter_(scene.image.filter) {}

Ray PathTracer::camera_ray(int x, int y, SampleStream& stream, PathScratch& scratch) const {
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
void PathTracer::see_lights(const Ray& ray, float distance, PathScratch& scratch) const {
  for (size_t i = 0; i < scene_.lights.size(); ++i) {
    const Light& light = scene_.lights.light(i);
    if (!light.visible()) continue;
    const auto hit = light.intersect(ray.origin, ray.direction);
    if (!hit || hit->distance > distance) continue;
    scratch.sample.radiance += hit->radiance;
    if (!layers_.empty()) scratch.by_layer[layers_.emitted(i)] += hit->radiance;
  }
}

/// Direct light by points on lights: of several points the ones that shadow rays go to are drawn in
/// proportion to what would arrive if nothing stood in between [Talbot05].
void PathTracer::sample_lights(const ScatterPoint& point, Path& path) const {
  const auto rays = static_cast<uint32_t>(scene_.render.light_samples);
  const uint32_t count = rays * kCandidates;
  path.seek(kLight);
  const V2f u = path.stream.next2d();
  std::vector<LightPoint>& points = path.scratch.light_points;
  points.clear();
  double total = 0;
  for (uint32_t k = 0; k < count; ++k) {
    // Every point alone is anywhere with equal chance; together they are a lattice, the lights in turn.
    const float turn = u.y + static_cast<float>(k) * kGolden;
    const V2f at(std::min((u.x + static_cast<float>(k)) / static_cast<float>(count), kBelowOne),
                 std::min(turn - std::floor(turn), kBelowOne));
    if (const auto sample = light_point(point, at, path)) {
      points.push_back(*sample);
      total += sample->luminance;
    }
  }
  if (points.empty()) return;
  path.seek(kLightChoice);
  const double step = total / rays;
  double next = path.stream.next1d() * step, sum = 0;
  for (const LightPoint& at : points) {
    sum += at.luminance;
    int chosen = 0;
    for (; next < sum; next += step) ++chosen;
    if (chosen > 0) shadow_ray(point, at, static_cast<float>(chosen * step / (at.luminance * count)), path);
  }
}

/// The density that points on a light count with against directions drawn from the lobes, by that of one of
/// them. All points count where a lobe would find the light by rare chance, although few of them are asked
/// for their visibility: small lights that are bright are the noise of long paths. An environment is found by
/// every ray that gets out, so there only the shadow rays count.
float PathTracer::competing_pdf(float pdf, float distance) const {
  const float points = std::isfinite(distance) ? static_cast<float>(kCandidates) : 1.0f;
  return pdf * points * static_cast<float>(scene_.render.light_samples);
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

std::optional<LightPoint> PathTracer::light_point(const ScatterPoint& point, const V2f& u,
                                                  const Path& path) const {
  const LightSet::Choice choice = LightSet::choose(path.scratch.light_probabilities, u.x);
  if (!(choice.probability > 0)) return std::nullopt;
  const auto seen = scene_.lights.light(choice.light).sample(point.position(), {choice.remapped, u.y});
  if (!seen || !(seen->pdf > 0)) return std::nullopt;
  const auto sample = point.exit().toward(*seen);
  if (!sample) return std::nullopt;
  LightPoint result;
  result.light = choice.light;
  result.direction = sample->direction;
  result.distance = sample->distance;
  result.value = point.eval(sample->direction);
  const float pdf = choice.probability * sample->pdf;
  const float weight =
      options_.direct == DirectLight::kBoth
          ? power_weight(competing_pdf(pdf, sample->distance), arriving_pdf(result.value, path))
          : 1.0f;
  result.arriving = sample->radiance * (weight / pdf);
  result.luminance = luminance(result.value.total() * result.arriving);
  if (!(result.luminance > 0)) return std::nullopt;
  return result;
}

void PathTracer::shadow_ray(const ScatterPoint& point, const LightPoint& to, float factor, Path& path) const {
  Ray ray;
  ray.origin = point.start(to.direction);
  ray.direction = to.direction;
  ray.far = to.distance * kJustBefore;
  ray.time = path.time;
  if (!point.meets_own()) ray.start = path.hit.start;
  ++path.scratch.rays.shadow;
  const float through = accel_.transmittance(ray, path.scratch.thread);
  if (through > 0) path.add_scattered(to.light, to.value, to.arriving * (through * factor));
}

/// Lights along a ray drawn from the lobes of the current vertex `point`, in front of `distance`. With
/// `shadowed`, what lies between has yet to be found out.
void PathTracer::gather_lights(const ScatterPoint& point, const Ray& ray, float distance, float lobe_pdf,
                               bool shadowed, Path& path) const {
  const V3f from = point.exit().origin(ray.direction);
  for (size_t i = 0; i < scene_.lights.size(); ++i) {
    const Light& light = scene_.lights.light(i);
    const auto hit = light.intersect(from, ray.direction);
    if (!hit || hit->distance > distance || !(largest(hit->radiance) > 0)) continue;
    float weight = 1;
    if (options_.direct == DirectLight::kBoth) {
      const float pdf = path.scratch.light_probabilities[i] * point.exit().pdf(light, ray.direction, *hit);
      weight = power_weight(lobe_pdf, competing_pdf(pdf, hit->distance));
    }
    if (shadowed) {
      Ray shadow = ray;
      shadow.far = hit->distance * kJustBefore;
      ++path.scratch.rays.shadow;
      weight *= accel_.transmittance(shadow, path.scratch.thread);
    }
    if (weight > 0) path.add(i, path.first, path.throughput * hit->radiance * weight);
  }
}

/// Follows a direction drawn from the lobes to the next vertex. Returns false where the path ends.
bool PathTracer::sample_lobes(const ScatterPoint& point, Path& path) const {
  const bool last = is_last(path);
  if (last && options_.direct == DirectLight::kLightsOnly) return false;
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
  if (!(largest(path.weight) > 0)) return false;

  Ray ray;
  ray.origin = point.start(sample->wi);
  ray.direction = sample->wi;
  ray.time = path.time;
  if (!point.meets_own()) ray.start = path.hit.start;
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
  if (options_.direct != DirectLight::kLightsOnly) {
    gather_lights(point, ray, hit.distance, value.pdf * survived, false, path);
  }
  path.ray = ray;
  path.hit = hit;
  return static_cast<bool>(hit);
}

void PathTracer::trace(int x, int y, uint32_t sample, PathScratch& scratch) const {
  scratch.sample = FilmSample{};
  scratch.clamp.limit = scene_.render.clamp_indirect;
  scratch.by_layer.assign(layers_.size(), Rgb(0));
  scratch.light_probabilities.resize(scene_.lights.size());

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
    scene_.lights.probabilities(
        point.position(), [&](const V3f& wi) { return point.eval(wi).pdf; }, scratch.light_probabilities);
    if (options_.direct != DirectLight::kLobesOnly) sample_lights(point, path);
    if (!sample_lobes(point, path)) return;
  }
}

}  // namespace pelage
