// SPDX-License-Identifier: Apache-2.0
// Cost of `path` beyond its rays: processor time of a render of the bumpy ball over the time in which bare
// Embree traces the same rays, in the same order, on one thread.
#include <algorithm>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "base/process_usage.h"
#include "bench/ball_scene.h"
#include "render/accel/flush_denormals.h"
#include "render/frame/frame_geometry.h"
#include "render/path/path_tracer.h"
#include "render/render_frame.h"
#include "tests/render/accel/embree_scene.h"

namespace pelage::render_path {
namespace {

constexpr int kWidth = 192, kHeight = 108;
constexpr int kRuns = 3;

struct RecordedRay {
  Ray ray;
  bool shadow;
};

/// Notes every ray on its way to the real accelerator.
class Recorder final : public Accel {
 public:
  explicit Recorder(const Accel& accel) : accel_(accel) {}
  Hit closest(const Ray& ray, TraceThread& thread) const override {
    rays_.push_back({ray, false});
    return accel_.closest(ray, thread);
  }
  float transmittance(const Ray& ray, TraceThread& thread) const override {
    rays_.push_back({ray, true});
    return accel_.transmittance(ray, thread);
  }
  StrandCount strands_crossed(const Ray& ray, uint32_t max, TraceThread& thread) const override {
    return accel_.strands_crossed(ray, max, thread);
  }
  bool opaque() const override { return accel_.opaque(); }
  Box3f bounds() const override { return accel_.bounds(); }
  const std::vector<RecordedRay>& rays() const { return rays_; }

 private:
  const Accel& accel_;
  mutable std::vector<RecordedRay> rays_;
};

/// Processor seconds of all paths of the picture.
double trace_paths(const RenderScene& scene, const PathTracer& tracer, Film& film) {
  const auto scratch = tracer.make_scratch();
  const double start = cpu_seconds();
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int sample = 0; sample < scene.render.samples; ++sample) {
        tracer.trace(x, y, static_cast<uint32_t>(sample), *scratch);
        film.add(x, y, scratch->sample, scratch->by_layer);
      }
    }
  }
  return cpu_seconds() - start;
}

/// Processor seconds of Embree alone, without filter functions, for the same rays.
double replay(const EmbreeScene& bare, const std::vector<RecordedRay>& rays) {
  float sum = 0;
  const double start = cpu_seconds();
  for (const RecordedRay& recorded : rays) {
    const Ray& ray = recorded.ray;
    RTCRayHit r{};
    r.ray = {ray.origin.x,
             ray.origin.y,
             ray.origin.z,
             ray.near,
             ray.direction.x,
             ray.direction.y,
             ray.direction.z,
             ray.time,
             ray.far,
             ~0u,
             0,
             0};
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    EmbreeQuery query(nullptr);
    if (recorded.shadow) {
      embree_occluded(bare.get(), query, r.ray);
    } else {
      embree_intersect(bare.get(), query, r);
    }
    sum += r.ray.tfar;
  }
  const double seconds = cpu_seconds() - start;
  benchmark::DoNotOptimize(sum);
  return seconds;
}

void path_over_bare_rays(benchmark::State& state) {
  const FlushDenormals flush;
  const Workers workers;
  MemoryLedger ledger;
  NoProgress progress;
  FrameStatistics statistics;
  const BumpyBall ball = make_bumpy_ball(static_cast<size_t>(state.range(0)));
  const RenderScene scene =
      ball_scene(ball, ConeShellParams{}, {kWidth, kHeight, 16, static_cast<int>(state.range(1))}, ledger);
  const auto geometry = FrameGeometry::make(scene, {workers, ledger, progress}, statistics);
  const EmbreeScene bare({{&ball.strands, 0, {}}}, {&ball.skin}, {}, workers);

  const FilmLayers layers = FilmLayers::make({{"key", false}, {"rim", false}, {"sky", true}}, kLobeGroups);
  const Recorder recorder(geometry->accel());
  const PathTracer direct(scene, geometry->accel(), layers, {});
  const PathTracer recording(scene, recorder, layers, {});
  Film film(kWidth, kHeight, layers, ledger);
  trace_paths(scene, recording, film);

  double paths = 1e30, rays = 1e30;
  for (auto _ : state) {
    for (int run = 0; run < kRuns; ++run) {
      paths = std::min(paths, trace_paths(scene, direct, film));
      rays = std::min(rays, replay(bare, recorder.rays()));
    }
  }
  const double samples = double{kWidth} * kHeight * scene.render.samples;
  state.counters["path/bare"] = paths / rays;
  state.counters["us/path"] = 1e6 * paths / samples;
  state.counters["us/ray"] = 1e6 * rays / static_cast<double>(recorder.rays().size());
  state.counters["rays/path"] = static_cast<double>(recorder.rays().size()) / samples;
}
BENCHMARK(path_over_bare_rays)
    ->Name("path over bare rays")
    ->ArgNames({"strands", "bounces"})
    ->Args({100000, 0})
    ->Args({100000, 4})
    ->Args({1000000, 4})
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace pelage::render_path
