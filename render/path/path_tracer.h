// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "render/film/film.h"
#include "render/film/filter_sampler.h"
#include "render/frame/frame_shading.h"
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

/// A point on a light that a shadow ray may go to.
struct LightPoint {
  size_t light = 0;
  V3f direction{0};
  float distance = 0;
  FibreValue value;     ///< of the scattering towards it
  Rgb arriving{0};      ///< radiance, weighted, over the density of one point
  float luminance = 0;  ///< of what that scatters
};

/// The limit on light of single paths (render.clamp_indirect), and what it took away.
struct IndirectClamp {
  float limit = 0;  ///< luminance; 0 is none
  int64_t lost = 0,
          indirect = 0;  ///< luminance of all samples in parts of 65,536: integers add up in any order

  /// The part that is kept of light that reaches the camera as lobes[g] * light, summed over lobe groups g.
  float keep(const Rgb* lobes, const Rgb& light) {
    if (limit == 0) return 1;
    float all = 0;
    for (int g = 0; g < kLobeGroups; ++g) all += luminance(lobes[g] * light);
    const float kept = all > limit ? limit / all : 1;
    indirect += in_parts(all);
    lost += in_parts(all * (1 - kept));
    return kept;
  }

 private:
  static int64_t in_parts(float value) {
    return static_cast<int64_t>(std::min(double{value}, 1e9) * 65536);  // nothing of what is not a number
  }
};

/// Memory of one thread, reused from path to path.
struct PathScratch {
  FilmSample sample;
  std::vector<Rgb> by_layer;
  std::vector<float> light_probabilities;
  std::vector<LightPoint> light_points;
  RayCounts rays;
  IndirectClamp clamp;
  TraceThread thread;
};

/// Traces one path after another through a frame. A path is a function of (scene, pixel, number of the
/// sample).
///
/// At each vertex `light_samples` shadow rays go to lights, and the lobes are sampled. Where a shadow ray
/// goes is drawn from several points on lights, which are chosen by importance, by what they would scatter if
/// they were not occluded: evaluating a fibre costs a small part of tracing a ray [Talbot05]. The two
/// estimates of direct light are weighted by the power heuristic, the choice of the light and roulette
/// being part of the densities. Lights are transparent to rays and to each other. `bounces` scatterings
/// follow the first at most; paths end early, with the probability of losing their weight, by roulette.
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
  bool is_last(const Path& path) const;
  float arriving_pdf(const FibreValue& value, const Path& path) const;
  float competing_pdf(float pdf, float distance) const;
  std::optional<LightPoint> light_point(const ScatterPoint& point, const V2f& u, const Path& path) const;
  void shadow_ray(const ScatterPoint& point, const LightPoint& to, float factor, Path& path) const;
  bool sample_lobes(const ScatterPoint& point, Path& path) const;
  void gather_lights(const ScatterPoint& point, const Ray& ray, float distance, float lobe_pdf, bool shadowed,
                     Path& path) const;

  const RenderScene& scene_;
  const Accel& accel_;
  const FilmLayers& layers_;
  PathOptions options_;
  FrameShading shading_;
  FilterSampler filter_;
};

}  // namespace pelage
