// SPDX-License-Identifier: Apache-2.0
// The plugin in a renderer that throws its hair away: strands a second on one thread, from the cache of a
// groom to RiCurvesV; the time of the first call, apart from reading the scene; and the heap that the plugin
// holds during a call of RiCurvesV, relative to the arrays that it hands over. The yardstick is growing the
// same leaves without the plugin.
#include <algorithm>
#include <cstring>
#include <filesystem>

#include <benchmark/benchmark.h>

#include "base/file.h"
#include "base/module.h"
#include "base/temporary_folder.h"
#include "bench/yardstick.h"
#include "rib/host/hair_session.h"
#include "tests/support/allocation_meter.h"

namespace {

int64_t strands_seen = 0;
size_t bytes_before = 0;  // on the heap, when the present procedural was asked for its hair
double max_held = 0;      // bytes held during a call of RiCurvesV / bytes handed over

/// Bytes of a parameter of Curves, by its inline declaration.
double parameter_bytes(const char* declaration, double strands, double points) {
  if (std::strcmp(declaration, "P") == 0) return 12 * points;
  const double components = std::strstr(declaration, "color") || std::strstr(declaration, "point") ? 3
                            : std::strstr(declaration, "[2]")                                      ? 2
                                                                                                   : 1;
  const bool per_strand = std::strstr(declaration, "uniform") != nullptr;
  return 4 * components * (per_strand ? strands : points - 2 * strands);
}
struct Nested {
  void* data;
  void (*subdivide)(void*, float);
  void (*free)(void*);
};
std::vector<Nested> waiting;

}  // namespace

#define RI_FUNCTION extern "C" __attribute__((visibility("default"), used))
RI_FUNCTION void RiBasis(float (*)[4], int, float (*)[4], int) {}
RI_FUNCTION void RiMotionBeginV(int, float*) {}
RI_FUNCTION void RiMotionEnd() {}
RI_FUNCTION void RiCurvesV(char*, int count, int* vertices, char*, int parameters, char** tokens, void**) {
  strands_seen += count;
  double points = 0;
  for (int i = 0; i < count; ++i) points += vertices[i];
  double given = 4.0 * count;
  for (int i = 0; i < parameters; ++i) given += parameter_bytes(tokens[i], count, points);
  const auto held = static_cast<double>(pelage::live_bytes()) - static_cast<double>(bytes_before);
  max_held = std::max(max_held, held / given);
}
RI_FUNCTION void RiProcedural(void* data, float*, void (*subdivide)(void*, float), void (*free)(void*)) {
  waiting.push_back({data, subdivide, free});
}

namespace pelage {
namespace {

/// The scene examples/tuft.yaml, whose groom is cached in a temporary folder.
const std::string& arguments() {
  static const TemporaryFolder folder;
  static const std::string text =
      std::string(PELAGE_EXAMPLES "/tuft.yaml coat=coat threads=1 detail=full ") +
      "'set=grooms.coat.cache={freeze: color, directory: " + folder.path().string() + "}'";
  return text;
}

struct Plugin {
  Module module{"pelage_ri"};
  void* (*convert)(char*) = reinterpret_cast<void* (*)(char*)>(module.symbol("ConvertParameters"));
  void (*subdivide)(void*, float) = reinterpret_cast<void (*)(void*, float)>(module.symbol("Subdivide"));
  void (*free)(void*) = reinterpret_cast<void (*)(void*)>(module.symbol("Free"));

  void first() const {
    std::string text = arguments();
    void* data = convert(text.data());
    subdivide(data, 1e38f);
    free(data);
  }
  void all() const {
    first();
    while (!waiting.empty()) {
      const Nested next = waiting.back();
      waiting.pop_back();
      bytes_before = live_bytes();
      next.subdivide(next.data, 1e38f);
      next.free(next.data);
    }
  }
};
const Plugin& plugin() {
  static const Plugin one;
  return one;
}

void whole_coat(benchmark::State& state) {
  plugin().all();
  const HairSession session(parse_hair_arguments(arguments()));
  const auto frame = session.frame(1, "tuft");
  const auto tree = session.tree(*frame, 0, {});
  const double growing = seconds_per_call(
      [&](int) {
        size_t points = 0;
        for (size_t leaf = 0; leaf < tree->all().end; ++leaf)
          points += session.grow(*tree, leaf).point_count();
        return points;
      },
      3);
  strands_seen = 0;
  max_held = 0;
  {
    const RatioTo ratio(state, "x_growing", growing);
    for (auto _ : state) plugin().all();
  }
  state.SetItemsProcessed(strands_seen);
  state.counters["held_of_given"] = max_held;
}

void first_call(benchmark::State& state) {
  plugin().all();
  for (auto _ : state) {
    plugin().first();
    state.PauseTiming();
    for (const Nested& one : waiting) one.free(one.data);
    waiting.clear();
    state.ResumeTiming();
  }
}

BENCHMARK(whole_coat)->Unit(benchmark::kMillisecond);
BENCHMARK(first_call)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pelage

BENCHMARK_MAIN();
