// SPDX-License-Identifier: Apache-2.0
// What it costs that fur stands in chunks: rays against chunks that grew when a ray met them and are all
// resident, over the same rays against one fur tree over everything, on one thread. Runs alternate, and of
// each the best counts.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "base/progress.h"
#include "base/statistics.h"
#include "bench/ball_chunks.h"
#include "bench/furball.h"
#include "procedurals/segment_parts.h"
#include "render/accel/chunk_accel.h"
#include "render/accel/flush_denormals.h"

namespace pelage {
namespace {

constexpr int kRuns = 7;

/// The strands of a furball in chunks of at most `chunk_strands`.
class FurballChunks final : public ChunkGrower {
 public:
  FurballChunks(const Strands& strands, size_t chunk_strands) {
    std::vector<size_t> ends;
    const std::vector<uint32_t> order = neighbours(strands, chunk_strands, ends);
    size_t begin = 0;
    for (size_t end : ends) {
      chunks_.push_back(pick(strands, order, begin, end));
      begin = end;
    }
  }
  ChunkContents grow(uint32_t chunk) const override { return {FurContents{chunks_[chunk], {}}, 0}; }
  ChunkCounts counts(uint32_t chunk) const override {
    ChunkCounts n;
    n.strands = chunks_[chunk].strand_count();
    n.points = chunks_[chunk].point_count();
    n.segments = n.points - n.strands;
    return n;
  }
  StrandScale scale(uint32_t) const override { return {2 * chunks_[0].radius(0), V3f(0)}; }
  /// As they are measured before the first ray.
  std::vector<ChunkBounds> bounds() const {
    std::vector<ChunkBounds> bounds;
    for (const Strands& strands : chunks_) bounds.push_back(SegmentParts(strands).exact_bounds(1));
    return bounds;
  }

 private:
  std::vector<Strands> chunks_;
};

double seconds(const Accel& accel, const std::vector<Ray>& rays, bool shadow, size_t& hits) {
  TraceThread thread;
  hits = 0;
  const double start = cpu_seconds();
  for (const Ray& ray : rays)
    hits += shadow ? accel.transmittance(ray, thread) == 0 : static_cast<bool>(accel.closest(ray, thread));
  return cpu_seconds() - start;
}

void lazy_over_eager(benchmark::State& state) {
  const FlushDenormals flush;
  const Strands strands = make_furball(static_cast<size_t>(state.range(0)));
  const FurballChunks many(strands, static_cast<size_t>(state.range(1))),
      one(strands, strands.strand_count());
  MemoryLedger ledger;
  NoProgress progress;
  ChunkAccelOptions options;
  options.kind = AccelKind::kFur;
  const ChunkAccel lazy(many.bounds(), many, options, ledger, Workers(1), progress);
  options.eager = true;
  const ChunkAccel eager(std::vector<ChunkBounds>(1), one, options, ledger, Workers(1), progress);
  const std::vector<Ray> deep = rays_deep_in_furball(100000), camera = camera_rays_at_furball(316);
  for (auto _ : state) {
    const auto compare = [&](const std::string& name, const std::vector<Ray>& rays, bool shadow) {
      double best[2] = {1e30, 1e30};
      size_t hits[2];
      seconds(lazy, rays, shadow, hits[0]);  // until all is resident
      for (int run = 0; run < kRuns; ++run) {
        best[0] = std::min(best[0], seconds(lazy, rays, shadow, hits[0]));
        best[1] = std::min(best[1], seconds(eager, rays, shadow, hits[1]));
      }
      if (hits[0] != hits[1]) state.SkipWithError("chunks change the answer");
      state.counters[name + " lazy/eager time"] = best[0] / best[1];
      state.counters[name + " Mray/s eager"] = static_cast<double>(rays.size()) / best[1] * 1e-6;
    };
    compare("1 occlusion", deep, true);
    compare("2 closest", deep, false);
    compare("3 camera", camera, false);
  }
}
BENCHMARK(lazy_over_eager)
    ->Name("fur in chunks over one tree")
    ->ArgNames({"strands", "chunk"})
    ->Args({100000, 2000})
    ->Args({100000, 8000})
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace pelage
