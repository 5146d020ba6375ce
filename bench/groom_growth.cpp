// SPDX-License-Identifier: Apache-2.0
//
// Cost of growth: strands per second and core through length + comb + clump + frizz + width at 8 points, the
// same in evaluations of the rest surface (the yardstick), efficiency of all cores, and peak memory over the
// bytes of the strands. Follicles per second for placing them.
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <new>
#include <vector>

#include <benchmark/benchmark.h>
#include <malloc.h>

#include "base/parallel.h"
#include "base/process_usage.h"
#include "base/temporary_folder.h"
#include "groom/cache/cache_report.h"
#include "groom/groom.h"
#include "groom/operators/color.h"
#include "image/field_operations.h"
#include "image/texture_library.h"
#include "tests/groom/shapes.h"
#include "tests/groom/stacks.h"
#include "tests/support/quiet_job.h"

namespace {

// Every byte that operator new hands out, to see the peak of a growth.
std::atomic<int64_t> bytes_in_use{0};
std::atomic<int64_t> bytes_peak{0};

void* count_allocation(size_t size) {
  void* p = std::malloc(size);
  if (!p) throw std::bad_alloc();
  const int64_t now = bytes_in_use += static_cast<int64_t>(malloc_usable_size(p));
  int64_t peak = bytes_peak;
  while (now > peak && !bytes_peak.compare_exchange_weak(peak, now)) {
  }
  return p;
}

void count_release(void* p) {
  if (!p) return;
  bytes_in_use -= static_cast<int64_t>(malloc_usable_size(p));
  std::free(p);
}

}  // namespace

void* operator new(size_t size) { return count_allocation(size); }
void operator delete(void* p) noexcept { count_release(p); }
void operator delete(void* p, size_t) noexcept { count_release(p); }

namespace pelage {
namespace {

/// Which coat: the usual operators, with a colour that varies along strands and over the skin, from a cache.
struct Kind {
  bool colored = false;
  const char* freeze = "";  // no cache
};

struct Coat {
  std::shared_ptr<const LimitSurface> rest = shapes::surface_of(shapes::ball_cage(10));
  MemoryLedger ledger;
  TextureLibrary textures{ledger};
  TemporaryFolder folder;
  std::shared_ptr<const Groom> groom;

  explicit Coat(const Kind& kind) {
    GroomParams params;
    params.strands = 200000;
    params.operators = stacks::usual();
    if (kind.colored) {
      ColorParams color;
      color.value =
          product_field({noise_field({2.2f, 0.45f, 1.0f, 0}), ramp_field({RampAxis::kStrand,
                                                                          {{0, Rgb(0.16f, 0.15f, 0.15f)},
                                                                           {0.4f, Rgb(0.2f, 0.16f, 0.15f)},
                                                                           {0.7f, Rgb(0.52f, 0.37f, 0.25f)},
                                                                           {1, Rgb(0.58f, 0.42f, 0.29f)}}})});
      color.variation = 0.3f;
      stacks::add<Color>(params.operators, color);
    }
    if (*kind.freeze) {
      params.cache.emplace();
      params.cache->directory.path = folder.path();
      params.cache->freeze.name = kind.freeze;
    }
    groom = Groom::create("coat", params, rest, textures, QuietJob(0, ledger));
  }
  PosedSkin pose() const { return {{rest.get(), 1}, {}, 1, {}}; }
  /// At the ends of a shutter.
  PosedSkin moving() const { return {both, {}, 1, {}}; }
  std::vector<LimitSurface> both{*rest, *rest};
};

const Coat& coat() {
  static const Coat one(Kind{});
  return one;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Seconds for one evaluation of position and frame at a root of the coat.
double seconds_per_root() {
  const FollicleTree& follicles = coat().groom->follicles();
  const auto start = std::chrono::steady_clock::now();
  V3f sum(0);
  for (size_t f = 0; f < follicles.size(); ++f) {
    const RootAddress& root = follicles.root(f);
    const SurfacePoint point = coat().rest->evaluate(root.face, root.u, root.v);
    sum += point.position + LimitSurface::frame_of(point).normal;
  }
  benchmark::DoNotOptimize(sum);
  return seconds_since(start) / static_cast<double>(follicles.size());
}

/// Grows all leaves and keeps them, as a renderer would.
double grow_all(const Coat& coat, const PosedSkin& pose, const Workers& workers, int64_t& strand_bytes) {
  const Groom& groom = *coat.groom;
  const size_t leaves = groom.follicles().leaves().size();
  std::vector<Strands> grown(leaves);
  const auto start = std::chrono::steady_clock::now();
  workers.for_each(leaves, 1, [&](WorkRange range) {
    for (size_t leaf = range.begin; leaf < range.end; ++leaf) grown[leaf] = groom.grow(leaf, pose);
  });
  const double seconds = seconds_since(start);
  strand_bytes = 0;
  for (const Strands& strands : grown) strand_bytes += static_cast<int64_t>(strands.bytes());
  return seconds;
}

void growth(benchmark::State& state) {
  const Workers one(1);
  const auto strands = static_cast<double>(coat().groom->follicles().size());
  double best = 1e30, root = 1e30;
  int64_t bytes = 0;
  for (auto _ : state) {
    best = std::min(best, grow_all(coat(), coat().pose(), one, bytes));
    root = std::min(root, seconds_per_root());
  }
  state.counters["strands_per_s"] = strands / best;
  state.counters["roots_per_strand"] = best / strands / root;
}
BENCHMARK(growth)->Unit(benchmark::kMillisecond)->Iterations(3);

/// Processor seconds, which a busy machine falsifies less than the clock does.
double cpu_of_growth(const Coat& coat, const PosedSkin& pose, const Workers& workers) {
  int64_t bytes = 0;
  const double start = cpu_seconds();
  grow_all(coat, pose, workers, bytes);
  return cpu_seconds() - start;
}

/// Growth from a cache. `freeze`: the last frozen operator; `moving`: grown at both ends of a shutter.
void growth_from_cache(benchmark::State& state, bool colored, const char* freeze, bool moving) {
  const Workers one(1);
  const Coat plain({colored, ""}), cached({colored, freeze});
  const auto pose = [&](const Coat& coat) { return moving ? coat.moving() : coat.pose(); };
  const auto strands = static_cast<double>(plain.groom->follicles().size());
  double without = 1e30, with = 1e30;
  for (auto _ : state) {
    without = std::min(without, cpu_of_growth(plain, pose(plain), one));
    for (int i = 0; i < 4; ++i) with = std::min(with, cpu_of_growth(cached, pose(cached), one));
  }
  state.counters["strands_per_s"] = strands / with;
  state.counters["times_faster"] = without / with;
  state.counters["roots_per_strand"] = with / strands / seconds_per_root();
  const GroomCacheReport& report = *cached.groom->cache_report();
  state.counters["disk_bytes_per_strand"] =
      static_cast<double>(report.offset_bytes + report.follicle_bytes) / strands;
}
BENCHMARK_CAPTURE(growth_from_cache, all_frozen, false, "width", false)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3);
BENCHMARK_CAPTURE(growth_from_cache, all_frozen_colored, true, "color", false)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3);
BENCHMARK_CAPTURE(growth_from_cache, all_frozen_colored_moving, true, "color", true)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3);
BENCHMARK_CAPTURE(growth_from_cache, live_color, true, "frizz", false)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(3);

void growth_on_all_cores(benchmark::State& state) {
  const Workers one(1), all;
  double single = 1e30, team = 1e30;
  double single_cpu = 1e30, team_cpu = 1e30;  // CPU time that threads cost each other, also on a busy machine
  int64_t bytes = 0, peak = 0;
  for (auto _ : state) {
    const double start = cpu_seconds();
    single = std::min(single, grow_all(coat(), coat().pose(), one, bytes));
    const double between = cpu_seconds();
    single_cpu = std::min(single_cpu, between - start);
    const int64_t before = bytes_in_use;
    bytes_peak = before;
    team = std::min(team, grow_all(coat(), coat().pose(), all, bytes));
    team_cpu = std::min(team_cpu, cpu_seconds() - between);
    peak = std::max(peak, bytes_peak - before);
  }
  state.counters["threads"] = all.thread_count();
  state.counters["efficiency"] = single / team / all.thread_count();
  state.counters["cpu_efficiency"] = single_cpu / team_cpu;
  state.counters["peak_over_strands"] = static_cast<double>(peak) / static_cast<double>(bytes);
  state.counters["bytes_per_strand"] =
      static_cast<double>(bytes) / static_cast<double>(coat().groom->follicles().size());
}
BENCHMARK(growth_on_all_cores)->Unit(benchmark::kMillisecond)->Iterations(3);

void follicles(benchmark::State& state) {
  double best = 1e30;
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    FollicleOptions options;
    options.count = state.range(0);
    benchmark::DoNotOptimize(FollicleTree::build(*coat().rest, options, QuietJob(1)));
    best = std::min(best, seconds_since(start));
  }
  state.counters["follicles_per_s"] = static_cast<double>(state.range(0)) / best;
  state.counters["roots_per_follicle"] = best / static_cast<double>(state.range(0)) / seconds_per_root();
}
BENCHMARK(follicles)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace pelage

BENCHMARK_MAIN();
