// SPDX-License-Identifier: Apache-2.0
// Cost of holding geometry in chunks: rays against chunks that are all resident, over the same rays against
// one eager compact Embree scene of the same strands, on one thread; and what a chunk costs in bytes and in
// time to build.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/hash.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "bench/ball_chunks.h"
#include "bench/yardstick.h"
#include "procedurals/bounds/segment_parts.h"
#include "render/accel/chunk_accel.h"
#include "render/accel/flush_denormals.h"
#include "render/accel/part_bounds.h"
#include "tests/render/accel/embree_accel.h"

namespace pelage {
namespace {

constexpr int kRuns = 5;

struct BallRays {
  std::vector<Ray> camera, gather, shadow;
};

/// Camera rays towards the ball, up to three random rays along each path that they start, and shadow rays
/// from every hit to two lights.
BallRays ball_rays(const Accel& accel, size_t pixels) {
  BallRays rays;
  TraceThread thread;
  const auto number = [](uint64_t i, uint64_t use) {
    return unit_float(hash64(i, use, random_use("bench")));
  };
  for (uint64_t i = 0; i < pixels * pixels; ++i) {
    const float x = (static_cast<float>(i % pixels) + number(i, 0)) / static_cast<float>(pixels) - 0.5f;
    const float y = (static_cast<float>(i / pixels) + number(i, 1)) / static_cast<float>(pixels) - 0.5f;
    Ray ray;
    ray.origin = {0, 0, 4.7f};
    ray.direction = V3f(0.65f * x, 0.65f * y, -1).normalized();
    rays.camera.push_back(ray);
    for (uint64_t bounce = 0; bounce < 3; ++bounce) {
      const Hit hit = accel.closest(ray, thread);
      if (!hit) break;
      const V3f place = ray.origin + hit.distance * ray.direction;
      for (uint64_t light = 0; light < 2; ++light) {
        const V3f at = light == 0 ? V3f(2.4f, 2.2f, 2.3f) : V3f(-2.2f, 1.8f, -2.8f);
        const V3f spot = at + V3f(number(i, 10 + bounce), number(i, 20 + bounce), number(i, 30 + bounce));
        Ray shadow;
        shadow.origin = place;
        shadow.direction = (spot - place).normalized();
        shadow.far = (spot - place).length();
        rays.shadow.push_back(shadow);
      }
      const float z = 2 * number(i, 40 + bounce) - 1, s = std::sqrt(1 - z * z);
      const float phi = 2 * std::numbers::pi_v<float> * number(i, 50 + bounce);
      ray = {};
      ray.origin = place;
      ray.direction = {s * std::cos(phi), s * std::sin(phi), z};
      rays.gather.push_back(ray);
    }
  }
  return rays;
}

double seconds(const Accel& accel, const std::vector<Ray>& rays, bool shadow, TraceThread& thread) {
  float sum = 0;
  const double start = cpu_seconds();
  for (const Ray& ray : rays) {
    sum += shadow ? accel.transmittance(ray, thread) : accel.closest(ray, thread).v;
  }
  const double result = cpu_seconds() - start;
  benchmark::DoNotOptimize(sum);
  return result;
}

/// Adds the columns of one kind of rays.
void compare(benchmark::State& state, const std::string& kind, const Accel& chunks, const Accel& eager,
             const std::vector<Ray>& rays, bool shadow, double& sum, double& eager_sum) {
  TraceThread thread;
  double best = 1e30, eager_best = 1e30;
  for (int run = 0; run < kRuns; ++run) {
    thread.counts = {};
    best = std::min(best, seconds(chunks, rays, shadow, thread));
    TraceThread other;
    eager_best = std::min(eager_best, seconds(eager, rays, shadow, other));
  }
  const auto n = static_cast<double>(rays.size());
  state.counters[kind + "/eager"] = best / eager_best;
  state.counters[kind + " us"] = 1e6 * best / n;
  state.counters[kind + " boxes"] = static_cast<double>(thread.counts.box_tests) / n;
  state.counters[kind + " visits"] = static_cast<double>(thread.counts.chunk_visits) / n;
  sum += best;
  eager_sum += eager_best;
}

/// Boxes as the first of two passes measures them.
std::vector<ChunkBounds> measured_bounds(const BallChunks& chunks) {
  std::vector<ChunkBounds> bounds;
  for (const ChunkContents& chunk : chunks.contents()) {
    const auto* fur = std::get_if<FurContents>(&chunk.geometry);
    bounds.push_back(fur ? SegmentParts(fur->strands).exact_bounds(1) : part_bounds(chunk, 1, 1));
  }
  return bounds;
}

void chunks_over_one_scene(benchmark::State& state) {
  const FlushDenormals flush;
  const Workers workers;
  MemoryLedger ledger;
  NoProgress progress;
  const auto strands = static_cast<size_t>(state.range(0));
  const BallChunks chunks(make_bumpy_ball(strands), static_cast<size_t>(state.range(1)));

  std::vector<AccelStrands> batches;
  for (size_t i = 0; i + 1 < chunks.contents().size(); ++i) {
    batches.push_back({&std::get<FurContents>(chunks.contents()[i].geometry).strands, 0, {}});
  }
  EmbreeOptions compact;
  compact.compact = true;
  const EmbreeAccel eager(batches, {&std::get<SkinMesh>(chunks.contents().back().geometry)}, compact,
                          workers);
  const BallRays rays = ball_rays(eager, 160);

  ResidentChunksOptions options;
  options.eager = state.range(2) == 0;
  options.kind = state.range(3) == 0 ? AccelKind::kEmbree : AccelKind::kFur;
  options.opaque = true;
  options.memory_limit = uint64_t(16) << 30;
  const ChunkAccel accel(
      options.eager ? std::vector<ChunkBounds>(chunks.contents().size()) : measured_bounds(chunks), chunks,
      options, Job{workers, ledger, progress});
  TraceThread warm;
  seconds(accel, rays.camera, false, warm);
  seconds(accel, rays.gather, false, warm);
  seconds(accel, rays.shadow, true, warm);

  for (auto _ : state) {
    double sum = 0, eager_sum = 0;
    compare(state, "camera", accel, eager, rays.camera, false, sum, eager_sum);
    compare(state, "gather", accel, eager, rays.gather, false, sum, eager_sum);
    compare(state, "shadow", accel, eager, rays.shadow, true, sum, eager_sum);
    state.counters["all/eager"] = sum / eager_sum;
  }
}
BENCHMARK(chunks_over_one_scene)
    ->Name("chunks over one eager compact scene")
    ->ArgNames({"strands", "chunk", "deferred", "fur"})
    ->Args({1000000, 2000, 1, 1})
    ->Args({1000000, 8000, 1, 1})
    ->Args({1000000, 8000, 0, 1})
    ->Args({1000000, 2000, 1, 0})
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

/// Bytes and time of one chunk.
void chunk_costs(benchmark::State& state) {
  const auto strands = static_cast<size_t>(state.range(0));
  const BallChunks chunks(make_bumpy_ball(strands * 25, 1, state.range(1) > 1 ? 0.1f : 0.0f), strands);
  MemoryLedger ledger;
  const EmbreeDevice device;
  SegmentPatterns patterns(ledger);
  double best = 1e30;
  size_t bytes = 0, peak = 0;
  for (auto _ : state) {
    for (int run = 0; run < kRuns; ++run) {
      ChunkContents contents = chunks.grow(3);
      const double start = cpu_seconds();
      const EmbreeChunk chunk(std::move(contents), 0, 0, {}, device, patterns);
      best = std::min(best, cpu_seconds() - start);
      bytes = chunk.bytes();
      peak = chunk.build_peak_bytes();
    }
  }
  const ChunkCounts counts = chunks.counts(3);
  const auto n = static_cast<double>(counts.strands);
  const EmbreeChunk chunk(chunks.grow(3), 3, 0, {}, device, patterns);
  const auto packed = static_cast<double>(chunk.strands()->bytes());
  state.counters["bytes/strand"] = static_cast<double>(bytes) / n;
  state.counters["of strands"] = packed / n;
  state.counters["tree/segment"] =
      (static_cast<double>(bytes) - packed) / static_cast<double>(counts.segments);
  state.counters["peak/segment"] = static_cast<double>(peak) / static_cast<double>(counts.segments);
  state.counters["reserved/strand"] = static_cast<double>(EmbreeChunk::bytes_bound(counts)) / n;
  state.counters["us/strand"] = 1e6 * best / n;
}
BENCHMARK(chunk_costs)
    ->Name("one chunk")
    ->ArgNames({"strands", "keys"})
    ->Args({500, 1})
    ->Args({2000, 1})
    ->Args({8000, 1})
    ->Args({8000, 2})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pelage
