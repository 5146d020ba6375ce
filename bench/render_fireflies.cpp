// SPDX-License-Identifier: Apache-2.0
// Fireflies: errors of fur rendered with few samples under lights of very different size.
//
// `fireflies`: the bumpy ball of 20,000 strands under a sky, two rectangles, a small bright sphere and a sun
// of half a degree. Errors of the fur pixels of 16 samples against 512, by pixel the mean over channels of (a
// - b)^2 / (b^2 + 0.01):
//
//   median, mean    over pixels and seeds
//   p999            exceeded by one pixel in a thousand
//   worst           share of the sum that is due to the worst pixel in a thousand
//   bias            mean of a - b over mean of b, and its standard error
//
// `weights`: rho / pdf of single samples, with inclination, place across the fibre, roughness and colour
// uniformly random; for the channel with the largest weight and (grey) for the mean of the channels.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "base/process_usage.h"
#include "bench/ball_scene.h"
#include "image/texture_library.h"
#include "render/fibre/fibre_material.h"
#include "render/frame/frame_geometry.h"
#include "render/frame/frame_loop.h"
#include "render/light/light_params.h"
#include "render/path/path_tracer.h"

namespace pelage::render_fireflies {
namespace {

constexpr int kSize = 72;
constexpr int kSeeds = 16;
constexpr uint32_t kReference = 512;
constexpr const char* kModels[] = {"chiang", "marschner", "deon", "yan", "cone-shell"};

MaterialParams model(int64_t which) {
  const auto with_color = [](auto params) -> MaterialParams {
    params.color = Field(Rgb(0.6f, 0.4f, 0.2f));
    return params;
  };
  switch (which) {
    case 0:
      return with_color(ChiangParams{});
    case 1:
      return with_color(MarschnerParams{});
    case 2:
      return with_color(DeonParams{});
    case 3:
      return with_color(YanParams{});
    default:
      return with_color(ConeShellParams{});
  }
}

/// All five lights, or `only` one of them (from 1).
LightSet lights(int64_t only, MemoryLedger& ledger) {
  TextureLibrary textures(ledger);
  RectangleLightParams key, rim;
  key.position = V3f(2.4f, 2.2f, 2.3f);
  key.look_at = rim.look_at = V3f(0);
  key.size = V2f(2, 2);
  key.radiance = Rgb(5);
  rim.position = V3f(-2.2f, 1.8f, -2.8f);
  rim.size = V2f(0.5f, 0.5f);
  rim.radiance = Rgb(120);
  SphereLightParams lamp, sun;
  lamp.position = V3f(-1.8f, 0.4f, 1.6f);
  lamp.radius = 0.05f;
  lamp.radiance = Rgb(1500);
  sun.position = V3f(-30, 80, 50);
  sun.radius = 0.43f;
  sun.radiance = Rgb(40000);
  EnvironmentLightParams sky;
  sky.radiance = Rgb(0.3f);
  const LightParams all[] = {sky, key, rim, lamp, sun};
  const char* names[] = {"sky", "key", "rim", "lamp", "sun"};
  std::vector<std::unique_ptr<Light>> made;
  for (int i = 0; i < 5; ++i) {
    if (only == 0 || only == i + 1) made.push_back(make_light(names[i], all[i], 1, textures, ledger));
  }
  return LightSet(std::move(made));
}

/// Errors of pixels, and the bias of each picture.
struct Errors {
  std::vector<double> all;
  std::vector<double> bias;  // by seed: mean of a - b over mean of b

  void add(const Film& film, const Film& truth) {
    double difference = 0, sum = 0;
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        if (truth.alpha(x, y) < 0.999f) continue;
        const Rgb a = film.radiance(x, y), b = truth.radiance(x, y);
        double error = 0;
        for (int c = 0; c < 3; ++c) {
          error += (a[c] - b[c]) * (a[c] - b[c]) / (b[c] * b[c] + 0.01f) / 3;
          difference += a[c] - b[c];
          sum += b[c];
        }
        all.push_back(error);
      }
    }
    bias.push_back(difference / sum);
  }
  void report(benchmark::State& state) {
    std::sort(all.begin(), all.end());
    const size_t rare = all.size() - all.size() / 1000;
    const double sum = std::accumulate(all.begin(), all.end(), 0.0);
    state.counters["median"] = all[all.size() / 2];
    state.counters["mean"] = sum / static_cast<double>(all.size());
    state.counters["p999"] = all[rare];
    state.counters["worst"] = std::accumulate(all.begin() + static_cast<long>(rare), all.end(), 0.0) / sum;
    double mean = 0, square = 0;
    for (const double b : bias) mean += b / kSeeds, square += b * b / kSeeds;
    state.counters["bias"] = mean;
    state.counters["bias_se"] = std::sqrt(std::max(0.0, square - mean * mean) / (kSeeds - 1));
  }
};

void fireflies(benchmark::State& state) {
  const Workers workers;
  MemoryLedger ledger;
  NoProgress progress;
  FrameStatistics statistics;
  const MaterialParams fibre = with_tables(model(state.range(0)), {workers, ledger, progress});
  RenderScene scene = ball_scene(make_bumpy_ball(20000), fibre,
                                 {kSize, kSize, 16, static_cast<int>(state.range(1)), 8000}, ledger);
  scene.lights = lights(state.range(2), ledger);
  const auto geometry = FrameGeometry::make(scene, {workers, ledger, progress}, statistics);
  const FilmLayers layers;
  const PathTracer tracer(scene, geometry->accel(), layers, {});
  const Stopwatch clock;
  const auto picture = [&](uint32_t samples, int64_t seed) {
    scene.render.seed = seed;
    auto film = std::make_unique<Film>(kSize, kSize, layers, ledger);
    FrameLoop loop(tracer, {workers, ledger, progress}, *film, frame_window(kSize, kSize, {}, layers.splat),
                   clock);
    loop.pass({[samples](size_t) { return samples; }});
    return film;
  };
  for (auto _ : state) {
    const auto truth = picture(kReference, 1);
    Errors errors;
    const double start = cpu_seconds();
    for (int seed = 0; seed < kSeeds; ++seed) errors.add(*picture(16, 100 + seed), *truth);
    state.counters["us/path"] = 1e6 * (cpu_seconds() - start) / (16.0 * kSize * kSize * kSeeds);
    errors.report(state);
  }
  state.SetLabel(kModels[state.range(0)]);
}
BENCHMARK(fireflies)
    ->ArgNames({"model", "bounces", "light"})
    ->ArgsProduct({{0, 1, 2, 3, 4}, {12}, {0}})
    ->ArgsProduct({{0}, {0, 1, 2}, {0}})
    ->ArgsProduct({{0}, {12}, {1, 2, 3, 4, 5}})
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

void weights(benchmark::State& state) {
  constexpr int kFibres = 4000, kSamples = 64;
  for (auto _ : state) {
    SampleStream stream(3, 0, 0, 0);
    std::vector<float> hued, grey;
    for (uint32_t i = 0; i < kFibres; ++i) {
      stream = SampleStream(3, i, 0, 0);
      const V3f size = stream.next3d(), color = stream.next3d(), place = stream.next3d();
      MaterialParams params = model(state.range(0));
      const Rgb sigma = ColorToAbsorption(0.3f)(Rgb(0.02f) + color * 0.96f);
      if (auto* p = std::get_if<ChiangParams>(&params)) {
        p->beta_m = 0.1f + 0.9f * size.x, p->beta_n = 0.1f + 0.9f * size.y, p->absorption = sigma;
      } else if (auto* m = std::get_if<MarschnerParams>(&params)) {
        m->beta = 1 + 14 * size.x, m->azimuthal_width = 2 + 28 * size.y, m->absorption = sigma;
      } else if (auto* d = std::get_if<DeonParams>(&params)) {
        d->beta = 1 + 14 * size.x, d->azimuthal_width = 2 + 28 * size.y, d->absorption = sigma;
      }
      const FibreMaterial material(params);
      FibrePoint point;
      point.tangents.fill(V3f(0, 0, 1));
      const float theta_o = kPi * (place.x - 0.5f);
      point.wo = V3f(std::cos(theta_o), 0, std::sin(theta_o));
      point.h = 2 * place.y - 1;
      const FibreBsdf bsdf = material.at(point);
      for (int k = 0; k < kSamples; ++k) {
        const std::optional<FibreSample> s = bsdf.sample(stream.next3d());
        const Rgb w = s ? s->value.total() / s->value.pdf : Rgb(0);
        hued.push_back(std::max({w.x, w.y, w.z}));
        grey.push_back((w.x + w.y + w.z) / 3);
      }
    }
    const auto report = [&](std::vector<float>& all, const std::string& name) {
      std::sort(all.begin(), all.end());
      state.counters[name + "_max"] = all.back();
      state.counters[name + "_p999"] = all[all.size() - all.size() / 1000];
      state.counters[name + "_mean"] = std::accumulate(all.begin(), all.end(), 0.0) / double(all.size());
    };
    report(hued, "w");
    report(grey, "grey");
  }
  state.SetLabel(kModels[state.range(0)]);
}
BENCHMARK(weights)->ArgName("model")->DenseRange(0, 2)->Iterations(1);

}  // namespace
}  // namespace pelage::render_fireflies
