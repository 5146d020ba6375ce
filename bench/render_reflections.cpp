// SPDX-License-Identifier: Apache-2.0
//
// Cost of reading a cell of the reflection cache, relative to loading a number from an array at a known
// index: from an array as large as the cache ("x_load"), and from one that holds nothing but the radiance
// ("x_dense"). Cells are read in random order. The radiance read last selects the next cell, so that the
// processor cannot read ahead.
#include <vector>

#include "base/hash.h"
#include "bench/interleaved.h"
#include "render/reflection/reflection_slots.h"

namespace pelage {
namespace {

constexpr size_t kReads = 200000, kSlices = 4, kPasses = 15;

void read(benchmark::State& state) {
  const auto cells = static_cast<uint32_t>(state.range(0));
  const auto lights = static_cast<size_t>(state.range(1));
  ReflectionTable table(lights, cells);
  std::vector<Rgb> dense(cells * lights, Rgb(1));
  const std::vector<Rgb> radiance(lights, Rgb(1));
  for (uint32_t cell = 0; cell < cells; ++cell) {
    const uint64_t key[] = {mix64(cell + 1)};
    table.add(key, 1, radiance);
  }
  table.finish(8);
  ReflectionSlots slots(lights, table.size());
  slots.add(table, 1);
  const size_t stride = slots.bytes() / sizeof(float) / cells;
  const std::vector<float> large(stride * cells, 1.0f);
  struct Read {
    uint64_t key;
    size_t cell;
  };
  std::vector<Read> order(kSlices * kReads);
  for (size_t i = 0; i < order.size(); ++i) {
    const uint64_t cell = hash64(uint64_t{i}) % cells;
    order[i] = {mix64(cell + 1), cell};
  }
  const auto read_all = [&](size_t slice, const auto& load) {
    float sum = 0;
    for (size_t i = 0; i < kReads; ++i) {
      Read read = order[slice * kReads + i];
      const auto no = static_cast<size_t>(sum < 0);  // never, but only the last value tells
      read.key += no, read.cell += no;
      sum += load(read);
    }
    benchmark::DoNotOptimize(sum);
  };
  for (auto _ : state) {
    const auto of_cache = [&](size_t slice) {
      read_all(slice, [&](const Read& at) { return slots.find(at.key, 0)[0].x; });
    };
    const Interleaved to_load(kSlices, kPasses, of_cache, [&](size_t slice) {
      read_all(slice, [&](const Read& at) { return large[at.cell * stride]; });
    });
    const Interleaved to_dense(kSlices, kPasses, of_cache, [&](size_t slice) {
      read_all(slice, [&](const Read& at) { return dense[at.cell * lights].x; });
    });
    to_load.show(state, "x_load");
    to_dense.show(state, "x_dense");
    state.counters["load_ns"] = 1e9 * to_load.second_s() / (kSlices * kReads);
  }
}
BENCHMARK(read)
    ->Name("reflection cache: read of (cells, lights)")
    ->Args({1 << 18, 1})
    ->Args({1 << 20, 1})
    ->Args({1 << 20, 3})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pelage
