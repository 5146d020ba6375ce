// SPDX-License-Identifier: Apache-2.0
// Processor time in which camera rays find what they see, over the time in which drawing finds the same: the
// bumpy ball, tile by tile, on one thread.
#include <algorithm>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "base/process_usage.h"
#include "bench/ball_scene.h"
#include "render/accel/flush_denormals.h"
#include "render/frame/frame_geometry.h"
#include "render/raster/tile_raster.h"

namespace pelage::render_raster {
namespace {

constexpr int kWidth = 960, kHeight = 540, kEvery = 8;  // one tile in kEvery

void rays_over_raster(benchmark::State& state) {
  const FlushDenormals flush;
  const Workers workers;
  MemoryLedger ledger;
  NoProgress progress;
  FrameStatistics statistics;
  const Job job{workers, ledger, progress};
  const auto count = static_cast<uint32_t>(state.range(1));
  const BumpyBall ball = make_bumpy_ball(static_cast<size_t>(state.range(0)));
  const RenderScene scene =
      ball_scene(ball, ConeShellParams{}, {kWidth, kHeight, static_cast<int>(count), 0}, ledger);
  const auto geometry = FrameGeometry::make(scene, job, statistics);
  const Accel& accel = geometry->accel();
  const CameraSamples samples(scene, accel, false);
  const TileRaster raster(scene, accel, geometry->chunks(), samples);
  const std::vector<Tile> tiles = tiles_along_curve(kWidth, kHeight, 16);
  TileRaster::Scratch scratch;
  TraceThread thread;
  double rays_s = 0, find_s = 0, hits_s = 0, draw_s = 0;
  int64_t same = 0, all = 0, hits = 0;
  std::vector<Hit> found;
  const auto for_each_sample = [&](const Tile& tile, const auto& use) {
    uint32_t pixel = 0;
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x, ++pixel) {
        for (uint32_t i = 0; i < count; ++i) {
          SampleStream stream = samples.stream(x, y, i);
          use(pixel, i, samples.sample(x, y, i, stream).ray);
        }
      }
    }
  };
  const auto seconds = [](const auto& run) {
    const double start = cpu_seconds();
    run();
    return cpu_seconds() - start;
  };
  for (uint32_t chunk = 0; chunk < geometry->chunks().size(); ++chunk)
    geometry->chunks().visit(chunk, 0, [](const ChunkGeometry&) {});
  for (auto _ : state) {
    for (size_t t = 0; t < tiles.size(); t += kEvery) {
      const Tile& tile = tiles[t];
      found.clear();
      float sum = 0;
      draw_s += seconds([&] {
        for_each_sample(tile, [&](uint32_t, uint32_t, const Ray& ray) { sum += ray.direction.x; });
      });
      benchmark::DoNotOptimize(sum);
      rays_s += seconds([&] {
        for_each_sample(
            tile, [&](uint32_t, uint32_t, const Ray& ray) { found.push_back(accel.closest(ray, thread)); });
      });
      find_s += seconds([&] { raster.find(tile, 0, count, job, 0, scratch); });
      size_t next = 0;
      hits_s += seconds([&] {
        for (uint32_t pixel = 0; next < found.size(); ++pixel) {
          for (uint32_t i = 0; i < count; ++i) {
            const Hit hit = raster.closest(pixel, i, thread, scratch);
            const Hit& other = found[next++];
            same += hit.distance == other.distance && hit.strand_id == other.strand_id ? 1 : 0;
            hits += hit ? 1 : 0;
          }
        }
      });
      TileRaster::end(thread, scratch);
      all += static_cast<int64_t>(found.size());
    }
  }
  const auto per = [](double part, int64_t of) { return 1e6 * part / static_cast<double>(of); };
  state.counters["rays/raster"] = rays_s / (find_s + hits_s);
  state.counters["us/ray"] = per(rays_s, all);
  state.counters["us/draw"] = per(draw_s, all);
  state.counters["us/find"] = per(find_s, all);
  state.counters["us/hit"] = per(hits_s, all);
  state.counters["same"] = static_cast<double>(same) / static_cast<double>(all);
  state.counters["covered"] = static_cast<double>(hits) / static_cast<double>(all);
  state.counters["traced"] = static_cast<double>(scratch.traced) / static_cast<double>(all);
}
BENCHMARK(rays_over_raster)
    ->Name("camera rays over raster")
    ->ArgNames({"strands", "samples"})
    ->Args({100000, 2})
    ->Args({100000, 16})
    ->Args({100000, 64})
    ->Args({1000000, 16})
    ->Args({1000000, 64})
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace pelage::render_raster
