// SPDX-License-Identifier: Apache-2.0
// Cost of one step of shading: random numbers, parts of fibre models, lights. The yardstick is a sine and a
// cosine of a float, as the C library computes them.
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/yardstick.h"
#include "render/fibre/fibre_material.h"
#include "render/light/environment_light.h"
#include "render/light/light_set.h"
#include "render/light/rectangle_light.h"
#include "render/light/sphere_light.h"
#include "render/sampling/sample_stream.h"
#include "render/sampling/warp.h"

namespace pelage {
namespace {

double sine_and_cosine() {
  static const double seconds = seconds_per_call([](int i) {
    const float x = 6.2831f * unit_float(mix64(i));
    return std::sin(x) + std::cos(x);
  });
  return seconds;
}

/// Put before each loop.
class Meter : RatioTo {
 public:
  explicit Meter(benchmark::State& state) : RatioTo(state, "x_sincos", sine_and_cosine()) {}
};

/// Inputs made before the clock runs: points, directions, numbers.
struct Inputs {
  static constexpr size_t kCount = 1024;
  std::vector<V3f> directions, points, numbers;

  Inputs() {
    for (uint32_t i = 0; i < kCount; ++i) {
      SampleStream stream(3, i, 0, 0);
      directions.push_back(uniform_direction(stream.next2d()));
      points.push_back(uniform_direction(stream.next2d()) * stream.next1d());
      numbers.push_back(stream.next3d());
    }
  }
};
const Inputs& inputs() {
  static const Inputs made;
  return made;
}

void stream_next2d(benchmark::State& state) {
  uint32_t i = 0;
  const Meter meter(state);
  for (auto _ : state) {
    SampleStream stream(1, 2, 3, ++i);
    for (int k = 0; k < 16; ++k) benchmark::DoNotOptimize(stream.next2d());
  }
}
BENCHMARK(stream_next2d)->Name("stream: construct, 16 times next2d");

void wigner_sample(benchmark::State& state) {
  const WignerTable& table = WignerTable::instance();
  size_t i = 0;
  const Meter meter(state);
  for (auto _ : state) benchmark::DoNotOptimize(table.sample(inputs().numbers[++i % Inputs::kCount].x));
}
BENCHMARK(wigner_sample)->Name("wigner: sample");

ConeShellMaterial material_of(benchmark::State& state) {
  ConeShellParams params;
  params.variant = state.range(0) ? ShellVariant::kLiteral : ShellVariant::kWigner;
  params.balance = 0.3f;
  return ConeShellMaterial(params);
}

ConeShellBsdf bsdf_at(const ConeShellMaterial& material, size_t i) {
  const std::vector<V3f>& d = inputs().directions;
  const size_t n = Inputs::kCount;
  return ConeShellBsdf(material, Rgb(0.5f, 0.3f, 0.2f), {d[i % n], d[(i + 1) % n], d[(i + 2) % n]},
                       d[(i + 3) % n]);
}

void cone_shell_construct(benchmark::State& state) {
  const ConeShellMaterial material = material_of(state);
  size_t i = 0;
  const Meter meter(state);
  for (auto _ : state) benchmark::DoNotOptimize(bsdf_at(material, ++i));
}
BENCHMARK(cone_shell_construct)->Name("cone-shell: construct")->ArgName("literal")->Arg(0)->Arg(1);

void cone_shell_eval(benchmark::State& state) {
  const ConeShellMaterial material = material_of(state);
  std::vector<ConeShellBsdf> bsdfs;
  for (size_t k = 0; k < 64; ++k) bsdfs.push_back(bsdf_at(material, k));
  size_t i = 0;
  const Meter meter(state);
  for (auto _ : state) {
    ++i;
    benchmark::DoNotOptimize(bsdfs[i % 64].eval(inputs().directions[i % Inputs::kCount]));
  }
}
BENCHMARK(cone_shell_eval)->Name("cone-shell: eval and pdf")->ArgName("literal")->Arg(0)->Arg(1);

void cone_shell_sample(benchmark::State& state) {
  const ConeShellMaterial material = material_of(state);
  std::vector<ConeShellBsdf> bsdfs;
  for (size_t k = 0; k < 64; ++k) bsdfs.push_back(bsdf_at(material, k));
  size_t i = 0;
  const Meter meter(state);
  for (auto _ : state) {
    ++i;
    benchmark::DoNotOptimize(bsdfs[i % 64].sample(inputs().numbers[i % Inputs::kCount]));
  }
}
BENCHMARK(cone_shell_sample)->Name("cone-shell: sample, eval and pdf")->ArgName("literal")->Arg(0)->Arg(1);

std::unique_ptr<Light> rectangle() {
  Rectangle shape;
  shape.center = {0, 4, 0};
  shape.x = {1, 0, 0};
  shape.y = {0, 0, 1};
  return std::make_unique<RectangleLight>("rectangle", shape, Rgb(1), true, false);
}
std::unique_ptr<Light> sphere() {
  return std::make_unique<SphereLight>("sphere", V3f(4, 1, 0), 1.0f, Rgb(1), false);
}
std::unique_ptr<Light> sky(int width) {
  static MemoryLedger ledger;
  Image image{width, width / 2, 3, std::vector<float>(static_cast<size_t>(width) * width / 2 * 3)};
  for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = unit_float(mix64(i / 3)) + 0.01f;
  return std::make_unique<EnvironmentLight>("sky", std::make_shared<const Texture>(std::move(image)), Rgb(1),
                                            rotation_xyz({0, 30, 0}), true, ledger);
}

void light_sample(benchmark::State& state, const Light& light) {
  size_t i = 0;
  const Meter meter(state);
  for (auto _ : state) {
    const V3f& u = inputs().numbers[++i % Inputs::kCount];
    benchmark::DoNotOptimize(light.sample(inputs().points[i % Inputs::kCount], {u.x, u.y}));
  }
}
void light_pdf(benchmark::State& state, const Light& light) {
  size_t i = 0;
  const Meter meter(state);
  for (auto _ : state) {
    ++i;
    benchmark::DoNotOptimize(
        light.pdf(inputs().points[i % Inputs::kCount], inputs().directions[i % Inputs::kCount]));
  }
}
void rectangle_sample(benchmark::State& state) { light_sample(state, *rectangle()); }
void sphere_sample(benchmark::State& state) { light_sample(state, *sphere()); }
void sky_sample(benchmark::State& state) { light_sample(state, *sky(static_cast<int>(state.range(0)))); }
void rectangle_pdf(benchmark::State& state) { light_pdf(state, *rectangle()); }
void sphere_pdf(benchmark::State& state) { light_pdf(state, *sphere()); }
void sky_pdf(benchmark::State& state) { light_pdf(state, *sky(static_cast<int>(state.range(0)))); }
BENCHMARK(rectangle_sample)->Name("rectangle: sample");
BENCHMARK(rectangle_pdf)->Name("rectangle: pdf");
BENCHMARK(sphere_sample)->Name("sphere: sample");
BENCHMARK(sphere_pdf)->Name("sphere: pdf");
BENCHMARK(sky_sample)->Name("environment: sample")->ArgName("width")->Arg(1024)->Arg(8192);
BENCHMARK(sky_pdf)->Name("environment: pdf")->ArgName("width")->Arg(1024)->Arg(8192);

void choose_among_three(benchmark::State& state) {
  std::vector<std::unique_ptr<Light>> lights;
  lights.push_back(rectangle());
  lights.push_back(sphere());
  lights.push_back(sky(512));
  const LightSet set(std::move(lights));
  std::vector<float> probabilities(set.size());
  size_t i = 0;
  const Meter meter(state);
  for (auto _ : state) {
    ++i;
    const size_t k = i % Inputs::kCount;
    set.probabilities(inputs().points[k], probabilities);
    benchmark::DoNotOptimize(LightSet::choose(probabilities, inputs().numbers[k].x));
  }
}
BENCHMARK(choose_among_three)->Name("light set: choose among three");

}  // namespace
}  // namespace pelage

BENCHMARK_MAIN();
