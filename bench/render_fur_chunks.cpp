// SPDX-License-Identifier: Apache-2.0
// Cost of dividing fur into chunks: rays against chunks that grew when a ray met them and are all resident,
// over the same rays against one fur tree over everything, on one thread.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "base/progress.h"
#include "bench/ball_chunks.h"
#include "bench/furball.h"
#include "bench/interleaved.h"
#include "procedurals/bounds/segment_parts.h"
#include "render/accel/chunk_accel.h"
#include "render/accel/flush_denormals.h"

namespace pelage {
namespace {

constexpr size_t kSliceRays = 2500, kPasses = 15;

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
  bool is_skin(uint32_t) const override { return false; }
  uint32_t part(uint32_t) const override { return 0; }
  ChunkCounts counts(uint32_t chunk) const override {
    ChunkCounts n;
    n.strands = chunks_[chunk].strand_count();
    n.points = chunks_[chunk].point_count();
    n.segments = n.points - n.strands;
    return n;
  }
  StrandScale scale(uint32_t) const override { return {2 * chunks_[0].radius(0), V3f(0)}; }
  /// The boxes as measured before the first ray.
  std::vector<ChunkBounds> bounds() const {
    std::vector<ChunkBounds> bounds;
    for (const Strands& strands : chunks_) bounds.push_back(SegmentParts(strands).exact_bounds(1));
    return bounds;
  }

 private:
  std::vector<Strands> chunks_;
};

/// Number of rays of a slice that hit something.
size_t trace(const Accel& accel, const std::vector<Ray>& rays, size_t slice, bool shadow) {
  TraceThread thread;
  size_t hits = 0;
  const size_t end = std::min(rays.size(), (slice + 1) * kSliceRays);
  for (size_t i = slice * kSliceRays; i < end; ++i) {
    hits += shadow ? accel.transmittance(rays[i], thread) == 0
                   : static_cast<bool>(accel.closest(rays[i], thread));
  }
  return hits;
}

/// The same picture from a direction that is not along an axis of the grid.
std::vector<Ray> from_a_corner(std::vector<Ray> rays) {
  const V3f z = V3f(1, 0.8f, 1).normalized(), x = V3f(1, 0, -1).normalized(), y = z.cross(x);
  const auto turned = [&](const V3f& p) { return p.x * x + p.y * y + p.z * z; };
  for (Ray& ray : rays) {
    ray.origin = turned(ray.origin);
    ray.direction = turned(ray.direction).normalized();
  }
  return rays;
}

void lazy_over_eager(benchmark::State& state) {
  const FlushDenormals flush;
  const Strands strands = make_furball(static_cast<size_t>(state.range(0)));
  const FurballChunks many(strands, static_cast<size_t>(state.range(1))),
      one(strands, strands.strand_count());
  MemoryLedger ledger;
  NoProgress progress;
  const Workers workers(1);
  const Job job{workers, ledger, progress};
  ResidentChunksOptions options;
  options.kind = AccelKind::kFur;
  const ChunkAccel lazy(many.bounds(), many, options, job);
  options.eager = true;
  const ChunkAccel eager(std::vector<ChunkBounds>(1), one, options, job);
  const std::vector<Ray> deep = rays_deep_in_furball(100000), camera = camera_rays_at_furball(316);
  for (auto _ : state) {
    const auto compare = [&](const std::string& name, const std::vector<Ray>& rays, bool shadow) {
      size_t hits[2] = {0, 0};
      const Interleaved times((rays.size() + kSliceRays - 1) / kSliceRays, kPasses,
                              [&](size_t slice) { hits[0] += trace(lazy, rays, slice, shadow); },
                              [&](size_t slice) { hits[1] += trace(eager, rays, slice, shadow); });
      if (hits[0] != hits[1]) state.SkipWithError("chunks change the answer");
      times.show(state, name + " lazy/eager time");
      state.counters[name + " Mray/s eager"] = static_cast<double>(rays.size()) / times.second_s() * 1e-6;
    };
    compare("1 occlusion", deep, true);
    compare("2 closest", deep, false);
    compare("3 camera", camera, false);
    compare("4 camera from a corner", from_a_corner(camera), false);
  }
}
BENCHMARK(lazy_over_eager)
    ->Name("fur in chunks over one tree")
    ->ArgNames({"strands", "chunk"})
    ->Args({100000, 500})
    ->Args({100000, 2000})
    ->Args({100000, 8000})
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace pelage
