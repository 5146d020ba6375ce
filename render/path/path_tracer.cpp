// SPDX-License-Identifier: Apache-2.0
#include "render/path/path_tracer.h"

#include "render/light/seen_lights.h"

namespace pelage {

struct PathTracer::Scratch final : SampleScratch {
  DirectLightScratch direct;
};

/// Adds up the light that a path contributes to its pixel, and divides it among the layers of the film.
class PathTracer::FilmSink {
 public:
  FilmSink(const FilmLayers& layers, SampleScratch& scratch) : layers_(layers), scratch_(scratch) {}

  void shadow(const PathState& path, const LightPoint& from, float factor, float through) {
    if (!(through > 0)) return;
    const Rgb light = from.arriving * (through * factor);
    if (path.vertex == 0) {
      add(path, from.light, from.value.lobes, light);
    } else {
      add(path, from.light, path.first, path.throughput * from.value.total() * light);
    }
  }

  void hit_light(const PathState& path, size_t light, const Rgb& radiance, float weight, float through) {
    weight *= through;
    if (weight > 0) add(path, light, path.first, path.throughput * radiance * weight);
  }

 private:
  /// Adds light that reaches the camera through lobe group g of the first surface as lobes[g] * light.
  void add(const PathState& path, size_t source, const Rgb* lobes, const Rgb& light) {
    const float kept = path.vertex > 0 ? scratch_.clamp.keep(lobes, light) : 1;
    Rgb total(0);
    for (int g = 0; g < kLobeGroups; ++g) {
      const Rgb part = lobes[g] * light * kept;
      total += part;
      if (g >= layers_.groups) continue;
      scratch_.by_layer[layers_.scattered(source, g)] += part;
      if (layers_.events && path.vertex == 0) scratch_.by_layer[layers_.direct(source, g)] += part;
    }
    scratch_.sample.radiance += total;
  }

  const FilmLayers& layers_;
  SampleScratch& scratch_;
};

PathTracer::PathTracer(const FrameScene& scene, const Accel& accel, const FilmLayers& layers,
                       const PathOptions& options)
    : scene_(scene),
      accel_(accel),
      layers_(layers),
      shading_(scene, options.balls),
      camera_(scene, accel, layers.splat.has_value()),
      catcher_(scene, accel),
      walk_(scene, accel, shading_, options) {}

std::unique_ptr<SampleScratch> PathTracer::make_scratch() const { return std::make_unique<Scratch>(); }

void PathTracer::trace(int x, int y, uint32_t sample, SampleScratch& memory) const {
  auto& scratch = static_cast<Scratch&>(memory);
  scratch.sample = FilmSample{};
  scratch.clamp.limit = scene_.render.clamp_indirect;
  scratch.by_layer.assign(layers_.size(), Rgb(0));

  PathState path(camera_.stream(x, y, sample));
  const CameraSample from = camera_.sample(x, y, sample, path.stream);
  scratch.sample.offset = from.offset;
  path.ray = from.ray;
  path.time = from.ray.time;
  path.random = from.ray.random;
  path.hit = scratch.closest(RayKind::kCamera, accel_, path.ray);
  const auto see = [&](size_t light, const Rgb& radiance) {
    scratch.sample.radiance += radiance;
    if (!layers_.empty()) scratch.by_layer[layers_.emitted(light)] += radiance;
  };
  seen_lights(scene_.lights, path.ray.origin, path.ray.direction, path.time, path.hit.distance, see);
  if (!path.hit) return;
  if (catcher_.is_catcher(path.hit)) {
    const auto blocked = catcher_.blocked(path.ray, path.hit, path.stream, scratch.direct, scratch);
    scratch.sample.alpha = blocked.alpha;
    background_lights(
        scene_.lights, path.ray.origin, path.ray.direction, path.time,
        [&](size_t light, const Rgb& radiance) { see(light, radiance * (Rgb(1) - blocked.fraction)); });
    return;
  }
  scratch.sample.alpha = 1;
  scratch.sample.surface = shading_.visible_surface(path.ray, path.hit, scratch.thread.hit_geometry);
  const ScatterPoint point = shading_.scatter_point(path.ray, path.hit, scratch.thread.hit_geometry);
  FilmSink sink(layers_, scratch);
  walk_.walk(point, path, scratch.direct, scratch, sink);
}

}  // namespace pelage
