// SPDX-License-Identifier: Apache-2.0
// Cost of bounding, evaluating and reading strands. The yardstick of bounds is the plain box of the same
// points; the yardstick of reading is reading the bytes of the file in one piece.
#include <filesystem>

#include <benchmark/benchmark.h>

#include "base/file.h"
#include "base/temporary_folder.h"
#include "bench/yardstick.h"
#include "geom/curve_bounds.h"
#include "geom/io/strand_file.h"
#include "tests/geom/random_strands.h"

namespace pelage::geom_strands {
namespace {

const Strands& fur(int motion_keys = 1) {
  const auto make = [](int keys) {
    RandomStrandOptions options;
    options.strands = 20000;
    options.min_points = options.max_points = 8;
    options.wander = 0.15f;
    options.radius = 0.002f;
    options.motion_keys = keys;
    return random_strands(1, options);
  };
  static const Strands still = make(1);
  static const Strands moving = make(2);
  return motion_keys == 1 ? still : moving;
}

Box3f box_of_points(const Strands& strands) {
  Box3f box;
  for (size_t i = 0; i < strands.point_count(); ++i) box.extendBy(strands.point(i));
  return box;
}

double plain_box() {
  static const double seconds = seconds_per_call([](int) { return box_of_points(fur()); }, 10);
  return seconds;
}

template <class Function>
void per_segment(benchmark::State& state, Function function) {
  const Strands& strands = fur();
  {
    const RatioTo ratio(state, "x_plain_box", plain_box());
    for (auto _ : state) {
      for (size_t s = 0; s < strands.strand_count(); ++s) {
        for (uint32_t i = 0; i < 7; ++i) benchmark::DoNotOptimize(function(bezier_segment(strands, s, i)));
      }
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(strands.strand_count()) * 7);
}

void segments(benchmark::State& state) {
  per_segment(state, [](const CubicSegment& s) { return s; });
}
BENCHMARK(segments)->Name("segments: Bezier form")->Unit(benchmark::kMillisecond);

void hulls(benchmark::State& state) { per_segment(state, hull_bounds); }
BENCHMARK(hulls)->Name("segments: hull bounds")->Unit(benchmark::kMillisecond);

void exact_boxes(benchmark::State& state) {
  per_segment(state, [](const CubicSegment& s) { return exact_bounds(s); });
}
BENCHMARK(exact_boxes)->Name("segments: exact bounds")->Unit(benchmark::kMillisecond);

void evaluate(benchmark::State& state) {
  per_segment(state, [](const CubicSegment& s) { return curve_position(s, 0.3f) + curve_tangent(s, 0.3f); });
}
BENCHMARK(evaluate)->Name("segments: position and tangent")->Unit(benchmark::kMillisecond);

void exact_batch(benchmark::State& state) {
  const Strands& strands = fur(static_cast<int>(state.range(0)));
  {
    const RatioTo ratio(state, "x_plain_box", plain_box());
    for (auto _ : state) benchmark::DoNotOptimize(exact_bounds(strands));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(strands.strand_count()));
}
BENCHMARK(exact_batch)
    ->Name("batch: exact bounds, motion keys")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond);

void read_strand_file(benchmark::State& state) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / (state.range(0) ? "a.tfx" : "a.hair");
  write_strands(path, fur());
  const double whole = seconds_per_call([&](int) { return read_file(path).size(); }, 5, 5);
  {
    const RatioTo ratio(state, "x_read_file", whole);
    for (auto _ : state) benchmark::DoNotOptimize(read_strands(path));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(fur().strand_count()));
}
BENCHMARK(read_strand_file)->Name("read: .hair (0), .tfx (1)")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pelage::geom_strands

BENCHMARK_MAIN();
