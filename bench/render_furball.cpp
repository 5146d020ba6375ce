// SPDX-License-Identifier: Apache-2.0
// Multiple scattering in pale fur: the ball that docs/lab/MEASURE.md describes, with the fibres of Chiang et
// al.: absorption 0.10, 0.18, 0.38 per radius, roughness 0.3, tilt 2 degrees.
//
//   cpu/16spp   processor seconds of 16 samples of a picture of 960 x 540, by the cost of a sample
//   relMSE16    mean over fur pixels and channels of (a - b)^2 / (b^2 + 0.01) at 16 samples
//   relMSE64    the same at 64
//   rays/path   rays of all kinds for each camera ray
//
// Errors are half the squared differences of pictures of independent seeds; b is the mean of other pictures
// of 64 samples. How Pelage compares with Cycles on this ball, on one machine in the same hour, is in
// docs/lab/MEASURE.md; seconds of different machines or hours must not be compared.
//
// Found on 4 cores at 2 GHz that others used five times over, which makes CPU seconds longer:
//
//   strands    bounces  lights  cpu/16spp  relMSE16  relMSE64
//   100,000    12       1       117        0.18      0.045
//   100,000    12       2       160        0.14      0.035
//   100,000    12       4       247        0.12      0.029
//   1,000,000  32       1       335        0.21      0.052
//
// Variance times rays is the same with one and two points on lights and a fifth more with four, hence
// light_samples: 1.
#include <cmath>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "base/process_usage.h"
#include "bench/ball_scene.h"
#include "render/frame/frame_geometry.h"
#include "render/frame/frame_loop.h"
#include "render/path/path_tracer.h"

namespace pelage::render_furball {
namespace {

constexpr int kWidth = 192, kHeight = 108;
constexpr int kSeeds = 6;

/// Mean over fur pixels and channels of half the squared difference of a and b over (t^2 + 0.01).
double relative_error(const Film& a, const Film& b, const std::vector<Rgb>& truth) {
  double sum = 0, count = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (!(a.alpha(x, y) > 0 && b.alpha(x, y) > 0)) continue;
      const Rgb& t = truth[static_cast<size_t>(y * kWidth + x)];
      const Rgb difference = a.radiance(x, y) - b.radiance(x, y);
      for (int c = 0; c < 3; ++c) sum += 0.5 * difference[c] * difference[c] / (t[c] * t[c] + 0.01) / 3;
      ++count;
    }
  }
  return sum / count;
}

void furball(benchmark::State& state) {
  const Workers workers;
  MemoryLedger ledger;
  NoProgress progress;
  FrameStatistics statistics;
  ChiangParams fibre;
  fibre.absorption = Rgb(0.10f, 0.18f, 0.38f);
  RenderScene scene = ball_scene(make_bumpy_ball(static_cast<size_t>(state.range(0))), fibre,
                                 {kWidth, kHeight, 64, static_cast<int>(state.range(1)), 8000}, ledger);
  scene.render.light_samples = static_cast<int>(state.range(2));
  const auto geometry = FrameGeometry::make(scene, {workers, ledger, progress}, statistics);
  const FilmLayers layers;
  const Stopwatch clock;
  double cpu_s = 0;
  const auto picture = [&](uint32_t samples, int64_t seed) {
    scene.render.seed = seed;
    auto film = std::make_unique<Film>(kWidth, kHeight, layers, ledger);
    const PathTracer tracer(scene, geometry->accel(), layers, {});
    FrameLoop loop(tracer, {workers, ledger, progress}, *film,
                   frame_window(kWidth, kHeight, {}, layers.splat), clock);
    const double start = cpu_seconds();
    loop.pass({[samples](size_t) { return samples; }});
    cpu_s = cpu_seconds() - start;
    loop.add_to(statistics);
    return film;
  };
  for (auto _ : state) {
    picture(1, 99);  // grows the chunks that rays hit
    std::vector<std::unique_ptr<Film>> at_16, at_64;
    double cpu_64_s = 0;
    for (int seed = 0; seed < kSeeds; ++seed) {
      at_16.push_back(picture(16, 10 + seed));
      at_64.push_back(picture(64, 20 + seed));
      cpu_64_s += cpu_s;
    }
    const auto truth_without = [&](int one, int other) {
      std::vector<Rgb> truth(size_t{kWidth} * kHeight, Rgb(0));
      for (int seed = 0; seed < kSeeds; ++seed) {
        if (seed == one || seed == other) continue;
        for (size_t i = 0; i < truth.size(); ++i) {
          truth[i] += at_64[seed]->radiance(static_cast<int>(i) % kWidth, static_cast<int>(i) / kWidth) /
                      float{kSeeds - 2};
        }
      }
      return truth;
    };
    double error_16 = 0, error_64 = 0;
    for (int seed = 0; seed < kSeeds; ++seed) {
      const int other = (seed + 1) % kSeeds;
      const std::vector<Rgb> truth = truth_without(seed, other);
      error_16 += relative_error(*at_16[seed], *at_16[other], truth) / kSeeds;
      error_64 += relative_error(*at_64[seed], *at_64[other], truth) / kSeeds;
    }
    const double samples = double{kWidth} * kHeight * 64 * kSeeds;
    const double cpu_16_s = cpu_64_s / samples * 960 * 540 * 16;
    state.counters["us/path"] = 1e6 * cpu_64_s / samples;
    state.counters["cpu/16spp"] = cpu_16_s;
    state.counters["relMSE16"] = error_16;
    state.counters["relMSE64"] = error_64;
    state.counters["rays/path"] =
        static_cast<double>(statistics.rays.total()) / static_cast<double>(statistics.rays.camera);
  }
}
BENCHMARK(furball)
    ->Name("furball, chiang")
    ->ArgNames({"strands", "bounces", "lights"})
    ->Args({100000, 12, 1})
    ->Args({100000, 12, 2})
    ->Args({100000, 12, 4})
    ->Args({1000000, 32, 1})
    ->Args({1000000, 32, 4})
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace pelage::render_furball
