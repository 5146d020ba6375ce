// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "render/accel/accel.h"
#include "render/frame/camera_samples.h"
#include "render/frame/frame_shading.h"
#include "render/frame/sample_scratch.h"
#include "render/light/direct_light.h"
#include "render/path/path_options.h"
#include "render/sampling/sample_stream.h"

namespace pelage {

/// The state of a path at its current vertex.
struct PathState {
  explicit PathState(const SampleStream& numbers) : stream(numbers) {}

  SampleStream stream;
  uint32_t vertex = 0;     ///< index of the current vertex; 0 is the first surface
  uint32_t random = 0;     ///< Ray::random of the last ray, for semi-transparent strands; each ray adds 1
  float time = 0;          ///< of the shutter, in [0, 1]
  Ray ray;                 ///< the ray that leads to the current vertex
  Hit hit;                 ///< hit of `ray` at the current vertex
  Rgb first[kLobeGroups];  ///< weight of the first vertex (rho / pdf), by lobe group
  Rgb throughput{1};       ///< product of the weights of the vertices after the first, roulette included
  Rgb weight{1};           ///< product of the weights of all vertices before this one, roulette included
  float attraction = 1;    ///< product of FibreValue::attraction of the same vertices
};

/// What a path does at a vertex that it has reached.
enum class Arrival {
  kGoOn,        ///< finds the light there, and continues
  kPass,        ///< continues without shadow rays
  kShadowRays,  ///< traces shadow rays to lights, and ends
  kEnd,         ///< ends
};

/// Continues paths from any scatter point, and reports the light that they find to a sink. At the first
/// vertex, a path traces up to `render.light_samples` shadow rays to lights (DirectLight), and at every later
/// vertex up to twice as many. At each vertex, it samples one direction from the lobes for the ray to the
/// next vertex. At most `render.bounces` scatterings follow the first. Roulette may end a path earlier; the
/// lower the weight of the path, the more likely (survival()).
///
/// A Sink has two members:
///   shadow(path, point, factor, through)
///       Receives the result of a shadow ray. The light that arrives at the current vertex is
///       point.arriving * factor * through, where `through` is the fraction that nothing blocks.
///   hit_light(path, light, radiance, weight, through)
///       Receives a light that the ray sampled from the lobes hits. The light that arrives at the current
///       vertex is radiance * weight * through, where `through` is the fraction that nothing blocks.
/// It may have two more:
///   arrive(path, hit_geometry)
///       Receives each vertex after the first, before its light is found. `hit_geometry`: the geometry that
///       was hit. Returns what the path does there, an Arrival. May change path.throughput.
///   branches(path)
///       Returns how many times the path continues from the current vertex, at least 1 (not from the first).
///
/// Thread safety: const members may be called from any thread, each with its own scratch.
template <class Sink>
class PathWalk {
 public:
  /// Keeps references to its arguments, except `options`.
  PathWalk(const FrameScene& scene, const Accel& accel, const FrameShading& shading,
           const PathOptions& options)
      : bounces_(static_cast<uint32_t>(scene.render.path_bounces())),
        accel_(accel),
        shading_(shading),
        options_(options),
        direct_(scene.lights, scene.render.light_samples, options.direct, options.far_lights,
                options.choice) {}

  /// Follows a path from its first vertex to its end. `first`: position and scattering of the first vertex.
  void walk(const ScatterPoint& first, PathState& path, DirectLightScratch& lights, SampleScratch& scratch,
            Sink& sink) const {
    if (scatter(first, path, Arrival::kGoOn, lights, scratch, sink)) walk_on(path, lights, scratch, sink);
  }
  /// Follows a path along `ray` from the first vertex to its end. The caller has sampled the direction of
  /// `ray` at the first vertex, and has divided `path.first` and `path.weight` by its density. Does not
  /// report the lights that `ray` itself hits.
  void follow(const Ray& ray, PathState& path, DirectLightScratch& lights, SampleScratch& scratch,
              Sink& sink) const {
    path.ray = ray;
    path.ray.random = ++path.random;
    path.hit = scratch.closest(RayKind::kIndirect, accel_, path.ray);
    if (path.hit) walk_on(path, lights, scratch, sink);
  }

  /// Returns the probability that roulette continues a path of this weight: the light that the path may still
  /// contribute, divided by the brightness of the pixel [Vorba16]; at most 1. If the probability were the
  /// weight itself, roulette would also end paths that contribute as much as others. In pale fur, it would
  /// save a quarter of the rays, but increase the variance by two thirds. `attraction`: what the weight would
  /// be larger by without magnets. They send many rays of low weight to where much light is expected, so the
  /// light that such a ray may still contribute is not small.
  static float survival(const Rgb& weight, float attraction) {
    return std::min(1.0f, attraction * max_component(weight) / kShown);
  }

 private:
  /// Rough guess of the brightness of a pixel, as a fraction of the light around the surface. It lies between
  /// the values for pale fur and for skin.
  static constexpr float kShown = 0.5f;

  /// Sets the next random number of the path to a dimension of the current vertex.
  static void seek(PathState& path, VertexDimension dimension) {
    pelage::seek(path.stream, dimension, path.vertex);
  }
  /// Continues a path that has hit its next vertex.
  void walk_on(PathState& path, DirectLightScratch& lights, SampleScratch& scratch, Sink& sink) const {
    bool goes_on = true;
    while (goes_on) {
      ++path.vertex;
      Arrival arrival = Arrival::kGoOn;
      if constexpr (requires { sink.arrive(path, scratch.thread.hit_geometry); })
        arrival = sink.arrive(path, scratch.thread.hit_geometry);
      if (arrival == Arrival::kEnd) return;
      const ScatterPoint point = shading_.scatter_point(path.ray, path.hit, scratch.thread.hit_geometry);
      if constexpr (requires { sink.branches(path); }) {
        if (const uint32_t count = sink.branches(path); count > 1) {
          branch(point, path, arrival, count, lights, scratch, sink);
          return;
        }
      }
      goes_on = scatter(point, path, arrival, lights, scratch, sink);
    }
  }
  /// Continues a path `count` times from its current vertex; the sink receives 1 / count of the light of each
  /// branch. Roulette treats each branch as the only one.
  void branch(const ScatterPoint& point, const PathState& path, Arrival arrival, uint32_t count,
              DirectLightScratch& lights, SampleScratch& scratch, Sink& sink) const {
    for (uint32_t i = 0; i < count; ++i) {
      PathState part = path;
      part.stream = path.stream.branch(i, count);
      part.random += i << 16;  // numbers that no ray of another branch has
      part.throughput /= static_cast<float>(count);
      if (scatter(point, part, arrival, lights, scratch, sink)) walk_on(part, lights, scratch, sink);
    }
  }
  /// Returns the count of shadow rays at the current vertex: after the first, twice as many. Such a vertex
  /// has cost two rays and more, so another shadow ray costs less than the noise that it removes [Vorba16,
  /// "splitting"].
  float shadow_rays(const PathState& path) const {
    return static_cast<float>(path.vertex == 0 ? direct_.rays() : 2 * direct_.rays());
  }
  bool is_last(const PathState& path) const { return path.vertex == bounces_; }

  /// Finds the light at the current vertex and, if the path continues, traces the ray to the next vertex.
  /// Returns false where the path ends.
  bool scatter(const ScatterPoint& point, PathState& path, Arrival arrival, DirectLightScratch& lights,
               SampleScratch& scratch, Sink& sink) const {
    direct_.begin(point, lights);
    if (arrival != Arrival::kPass && options_.direct != DirectTechniques::kLobesOnly)
      sample_lights(point, path, lights, scratch, sink);
    return arrival != Arrival::kShadowRays && sample_lobes(point, path, lights, scratch, sink);
  }
  float arriving_pdf(const FibreValue& value, const PathState& path) const;
  Ray leaving_ray(const ScatterPoint& point, const V3f& direction, const PathState& path) const;
  FibreValue dual_value(const DualScattering& dual, const FibreValue& direct, const Ray& shadow,
                        SampleScratch& scratch) const;
  void sample_lights(const ScatterPoint& point, PathState& path, DirectLightScratch& lights,
                     SampleScratch& scratch, Sink& sink) const;
  bool sample_lobes(const ScatterPoint& point, PathState& path, DirectLightScratch& lights,
                    SampleScratch& scratch, Sink& sink) const;
  void meet_lights(const ScatterPoint& point, const Ray& ray, float distance, float lobe_pdf, bool shadowed,
                   const PathState& path, const DirectLightScratch& lights, SampleScratch& scratch,
                   Sink& sink) const;

  const uint32_t bounces_;
  const Accel& accel_;
  const FrameShading& shading_;
  const PathOptions options_;
  const DirectLight direct_;
};

/// Returns the density with which sample_lobes() traces a ray in the direction whose scattering is `value`.
/// It is the density of the lobes times the probability of surviving roulette. Without the second factor, MIS
/// would leave the light that a dark surface scatters to a few rays of high weight.
template <class Sink>
float PathWalk<Sink>::arriving_pdf(const FibreValue& value, const PathState& path) const {
  if (!options_.roulette || is_last(path) || !(value.pdf > 0)) return value.pdf;
  return value.pdf * survival(path.weight * (value.total() / value.pdf), path.attraction * value.attraction);
}

template <class Sink>
Ray PathWalk<Sink>::leaving_ray(const ScatterPoint& point, const V3f& direction,
                                const PathState& path) const {
  Ray ray;
  ray.origin = point.start(direction);
  ray.direction = direction;
  ray.time = path.time;
  if (!point.can_hit_own_strand()) ray.start = path.hit.start;
  return ray;
}

template <class Sink>
void PathWalk<Sink>::sample_lights(const ScatterPoint& point, PathState& path, DirectLightScratch& lights,
                                   SampleScratch& scratch, Sink& sink) const {
  seek(path, VertexDimension::kLight);
  const auto lobe_pdf = [&](const FibreValue& value) { return arriving_pdf(value, path); };
  direct_.propose(point, path.stream.next2d(), lobe_pdf, lights);
  scratch.costs.occlusion.add_candidates(direct_.candidates(), lights.proved);
  if (lights.points.empty()) return;
  seek(path, VertexDimension::kLightChoice);
  direct_.choose(shadow_rays(path), path.stream.next1d(), lights, [&](const LightPoint& to, float factor) {
    Ray ray = leaving_ray(point, to.direction, path);
    ray.far = to.distance * DirectLight::kJustBefore;
    ray.casters = to.casters;
    if (const DualScattering* dual = point.dual()) {
      LightPoint scattered = to;
      scattered.value = dual_value(*dual, to.value, ray, scratch);
      sink.shadow(path, scattered, factor, 1);
      return;
    }
    sink.shadow(path, to, factor, scratch.light_through(accel_, ray));
  });
}

/// Returns the scattering of light that arrives along a shadow ray, `direct` where no strand is between.
template <class Sink>
FibreValue PathWalk<Sink>::dual_value(const DualScattering& dual, const FibreValue& direct, const Ray& shadow,
                                      SampleScratch& scratch) const {
  const DualScattering::Arriving arriving = dual.arriving(shadow.direction);
  const auto max = static_cast<uint32_t>(arriving.max_strands());
  const StrandCount between = scratch.strands_crossed(accel_, shadow, max);
  return arriving.eval(direct, between.strands, between.through);
}

/// Reports the lights that a ray sampled from the lobes of the current vertex `point` hits before `distance`.
/// With `shadowed`, traces a shadow ray to each of these lights to find the fraction that arrives; otherwise,
/// nothing blocks them.
template <class Sink>
void PathWalk<Sink>::meet_lights(const ScatterPoint& point, const Ray& ray, float distance, float lobe_pdf,
                                 bool shadowed, const PathState& path, const DirectLightScratch& lights,
                                 SampleScratch& scratch, Sink& sink) const {
  direct_.find_lights(
      point, ray.direction, distance, lobe_pdf, lights, [&](size_t light, const LightHit& hit, float weight) {
        float through = 1;
        if (shadowed) {
          Ray shadow = ray;
          shadow.far = hit.distance * DirectLight::kJustBefore;
          const bool proved = point.is_shadowed(shadow.direction, shadow.far);
          scratch.costs.occlusion.rays_proved += proved ? 1 : 0;
          if (const DualScattering* dual = point.dual(); dual && !proved) {
            PathState scattered = path;
            const FibreValue value = dual_value(*dual, point.eval(shadow.direction), shadow, scratch);
            for (int g = 0; g < kLobeGroups; ++g) scattered.first[g] = value.lobes[g] / lobe_pdf;
            sink.hit_light(scattered, light, hit.radiance, weight, 1);
            return;
          }
          through = proved ? 0 : scratch.light_through(accel_, shadow);
        }
        sink.hit_light(path, light, hit.radiance, weight, through);
      });
}

/// Traces a direction sampled from the lobes to the next vertex. Returns false where the path ends.
template <class Sink>
bool PathWalk<Sink>::sample_lobes(const ScatterPoint& point, PathState& path, DirectLightScratch& lights,
                                  SampleScratch& scratch, Sink& sink) const {
  const bool last = is_last(path);
  if (last && options_.direct == DirectTechniques::kLightsOnly) return false;
  seek(path, VertexDimension::kLobe);
  const auto sample = point.sample(path.stream.next3d());
  if (!sample) return false;
  const FibreValue& value = sample->value;
  if (path.vertex == 0) {
    for (int g = 0; g < kLobeGroups; ++g) path.first[g] = value.lobes[g] / value.pdf;
  } else {
    path.throughput *= value.total() / value.pdf;
  }
  path.weight *= value.total() / value.pdf;
  path.attraction *= value.attraction;
  if (!(max_component(path.weight) > 0)) return false;

  Ray ray = leaving_ray(point, sample->wi, path);
  if (last) {
    meet_lights(point, ray, ray.far, value.pdf, true, path, lights, scratch, sink);
    return false;
  }
  float survived = 1;
  if (options_.roulette) {
    survived = survival(path.weight, path.attraction);
    seek(path, VertexDimension::kRoulette);
    if (path.stream.next1d() >= survived) return false;
    path.throughput /= survived;
    path.weight /= survived;
  }
  ray.random = ++path.random;
  const Hit hit = scratch.closest(RayKind::kIndirect, accel_, ray);
  if (options_.direct != DirectTechniques::kLightsOnly) {
    meet_lights(point, ray, hit.distance, value.pdf * survived, false, path, lights, scratch, sink);
  }
  path.ray = ray;
  path.hit = hit;
  return static_cast<bool>(hit);
}

}  // namespace pelage
