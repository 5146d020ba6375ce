// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/film/film.h"
#include "render/film/filter_sampler.h"
#include "render/path/frame_shading.h"
#include "render/sampling/sample_stream.h"

namespace pelage {

/// Which techniques estimate direct light: both, combined by the power heuristic, or one alone. All converge
/// to the same picture; one alone is for tests and comparisons.
enum class DirectLight { kBoth, kLightsOnly, kLobesOnly };

struct PathOptions {
  DirectLight direct = DirectLight::kBoth;
  bool roulette = true;
};

/// Rays traced, by kind.
struct RayCounts {
  int64_t camera = 0, shadow = 0, indirect = 0;
};

/// Memory of one thread, reused from path to path.
struct PathScratch {
  FilmSample sample;
  std::vector<Rgb> by_layer;
  std::vector<float> light_probabilities;
  RayCounts rays;
  TraceThread thread;
};

/// Traces one path after another through a frame. A path is a function of (scene, pixel, number of the
/// sample).
///
/// At each vertex a light is chosen by importance and sampled, `light_samples` times, and the lobes are
/// sampled; the two estimates of direct light are weighted by the power heuristic, the choice of the light
/// being part of the density. Lights are transparent to rays and to each other. `bounces` scatterings follow
/// the first at most; paths end early, with the probability of losing their weight, by roulette.
class PathTracer {
 public:
  PathTracer(const RenderScene& scene, const Accel& accel, const FilmLayers& layers,
             const PathOptions& options);

  /// Leaves the result in `scratch.sample` and `scratch.by_layer`.
  void trace(int x, int y, uint32_t sample, PathScratch& scratch) const;

 private:
  struct Path;
  Ray camera_ray(int x, int y, SampleStream& stream, PathScratch& scratch) const;
  void see_lights(const Ray& ray, float distance, PathScratch& scratch) const;
  void sample_lights(const ScatterPoint& point, Path& path) const;
  void sample_light(const ScatterPoint& point, const V2f& u, Path& path) const;
  bool sample_lobes(const ScatterPoint& point, Path& path) const;
  void gather_lights(const V3f& from, const Ray& ray, float distance, float lobe_pdf, bool shadowed,
                     Path& path) const;

  const RenderScene& scene_;
  const Accel& accel_;
  const FilmLayers& layers_;
  PathOptions options_;
  FrameShading shading_;
  FilterSampler filter_;
};

}  // namespace pelage
