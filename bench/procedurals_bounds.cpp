// SPDX-License-Identifier: Apache-2.0
//
// Cost of bounding a chunk: a leaf of 8,000 strands through the usual operators, 8 points each. The yardstick
// is growing that leaf, which two-pass bounding does once more. Also the size of the resulting boxes,
// relative to the one exact box of the whole leaf.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "bench/yardstick.h"
#include "geom/curve_bounds.h"
#include "groom/groom.h"
#include "image/texture_library.h"
#include "procedurals/bounds/segment_parts.h"
#include "tests/groom/shapes.h"
#include "tests/groom/stacks.h"
#include "tests/support/quiet_job.h"

namespace pelage {
namespace {

struct Coat {
  std::shared_ptr<const LimitSurface> rest = shapes::surface_of(shapes::ball_cage(10));
  MemoryLedger ledger;
  TextureLibrary textures{ledger};
  std::shared_ptr<const Groom> groom;
  std::vector<LimitSurface> keys;

  Coat() {
    GroomParams params;
    params.strands = 200000;
    params.operators = stacks::usual();
    groom = Groom::create("coat", params, rest, textures, QuietJob(0, ledger));
    ControlMesh cage = shapes::ball_cage(10);
    for (int key = 0; key < 4; ++key) {
      keys.emplace_back(rest->shared_topology(), cage.positions);
      for (V3f& p : cage.positions) p = p * 1.01f + V3f(0.1f, 0, 0);
    }
  }
  PosedSkin pose(int64_t count) const {
    return {std::span(keys).first(static_cast<size_t>(count)), {}, 1, {}};
  }
  Strands grow(int64_t count) const { return groom->grow(5, pose(count)); }
};

const Coat& coat() {
  static const Coat one;
  return one;
}

double growth_seconds(int64_t keys) {
  return seconds_per_call([&](int) { return coat().grow(keys).strand_count(); }, 2, 5);
}

float surface_area(const Box3f& box) {
  const V3f d = box.size();
  return 2 * (d.x * d.y + d.y * d.z + d.z * d.x);
}

void divide(benchmark::State& state) {
  const Strands strands = coat().grow(1);
  const RatioTo ratio(state, "x_growth", growth_seconds(1));
  for (auto _ : state) benchmark::DoNotOptimize(SegmentParts(strands).cell_count());
}
BENCHMARK(divide)->Name("divide a leaf into parts")->Unit(benchmark::kMillisecond);

void measure(benchmark::State& state) {
  const Strands strands = coat().grow(state.range(0));
  const SegmentParts parts(strands);
  const int keys = static_cast<int>(state.range(1));
  {
    const RatioTo ratio(state, "x_growth", growth_seconds(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(parts.exact_bounds(keys));
  }
  double sum = 0;
  for (const Box3f& box : parts.exact_bounds(keys).boxes) sum += surface_area(box) / keys;
  state.counters["x_leaf_area"] = sum / surface_area(exact_bounds(strands));
}
BENCHMARK(measure)
    ->Name("measure its parts: motion keys, keys of boxes")
    ->Args({1, 1})
    ->Args({2, 1})
    ->Args({4, 1})
    ->Args({2, 2})
    ->Unit(benchmark::kMillisecond);

void conservative(benchmark::State& state) {
  const PosedSkin pose = coat().pose(state.range(0));
  {
    const RatioTo ratio(state, "x_growth", growth_seconds(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(coat().groom->conservative_bound(5, pose));
  }
  state.counters["x_leaf_area"] = surface_area(coat().groom->conservative_bound(5, pose)) /
                                  surface_area(exact_bounds(coat().grow(state.range(0))));
}
BENCHMARK(conservative)
    ->Name("conservative bound: motion keys")
    ->Arg(1)
    ->Arg(4)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pelage

BENCHMARK_MAIN();
