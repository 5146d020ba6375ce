// SPDX-License-Identifier: Apache-2.0
//
// Cost of a field of ten terms over the cost of its slowest term, per strand.
#include <chrono>

#include <benchmark/benchmark.h>

#include "base/hash.h"
#include "groom/strands/strand_fields.h"
#include "image/field_operations.h"
#include "image/field_places.h"

namespace pelage {
namespace {

/// Strands with random roots in the unit cube.
std::unique_ptr<StrandBatch> random_roots() {
  auto batch = std::make_unique<StrandBatch>();
  batch->count = kBlockStrands;
  batch->points.resize(8);
  for (size_t s = 0; s < batch->count; ++s) {
    V3f at;
    for (int axis = 0; axis < 3; ++axis) at[axis] = unit_float(hash64(s, static_cast<uint64_t>(axis)));
    batch->rest.set(s, at, Frame{});
    batch->ids[s] = s;
    batch->u[s] = batch->v[s] = batch->clump[s] = 0;
    batch->face[s] = 0;
    batch->face_u[s] = batch->face_v[s] = 0;
  }
  return batch;
}

double seconds(const Field& field, const StrandBatch& batch) {
  StrandRow row;
  double best = 1;
  for (int run = 0; run < 50; ++run) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 20; ++i) evaluate(field, batch, 0, row);
    benchmark::DoNotOptimize(row);
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best / (20.0 * static_cast<double>(batch.count));
}

void TenTerms(benchmark::State& state) {
  const auto batch = random_roots();
  const Field noise = noise_field({4, 1, 0.5f, 7});
  const Field box = box_field({V3f(0.8f), V3f(0.5f), 0.1f}, {});
  const Field slope = slope_field({V3f(0, 0, 1)});
  // noise, invert, clamp, threshold, a box, a slope, a constant, mix, add and step
  const Field ten = step_field(
      sum_field(
          {mix_field(threshold_field(clamp_block_field(inverted_field(noise), 0, 1), 0.5f, 0.2f), box, slope),
           Field(0.5f)}),
      0.1f);
  double one = 0, all = 0;
  for (auto _ : state) {
    one = seconds(noise, *batch);
    all = seconds(ten, *batch);
  }
  state.counters["ns of the slowest term"] = one * 1e9;
  state.counters["ten terms / slowest term"] = all / one;
}
BENCHMARK(TenTerms)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pelage
