// SPDX-License-Identifier: Apache-2.0
#include "render/path/path_integrator.h"

#include <algorithm>
#include <atomic>
#include <optional>

#include "base/parallel.h"
#include "base/stopwatch.h"
#include "render/accel/flush_denormals.h"
#include "render/memory_budget.h"
#include "render/path/frame_geometry.h"
#include "render/path/tile_order.h"

namespace pelage {
namespace {

constexpr int kTileSide = 16;

/// How many lobe groups a material uses, from the first.
int lobe_groups(const MaterialParams& material) {
  if (std::holds_alternative<LambertParams>(material)) return 1;
  return std::holds_alternative<GlossyParams>(material) ? 2 : kLobeGroups;
}

FilmLayers film_layers(const RenderScene& scene) {
  if (!scene.image.light_layers) return {};
  std::vector<FilmLayers::LightInfo> lights;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    lights.push_back({scene.lights.light(i).name(), scene.lights.light(i).visible()});
  }
  int groups = 1;
  for (const MaterialParams& material : scene.materials) groups = std::max(groups, lobe_groups(material));
  return FilmLayers::make(lights, groups);
}

/// Traces passes of samples over a film.
class FrameLoop {
 public:
  FrameLoop(const PathTracer& tracer, const Workers& workers, Progress& progress, Film& film)
      : tracer_(tracer),
        workers_(workers),
        progress_(progress),
        film_(film),
        scratch_(static_cast<size_t>(workers.thread_count())) {
    for (size_t i = 0; i < scratch_.size(); ++i) scratch_[i].thread.worker = static_cast<int>(i);
  }

  /// Adds samples `first` .. `last` - 1 to every pixel of the tiles. Returns false when cancelled on the way.
  bool pass(const std::vector<Tile>& tiles, uint32_t first, uint32_t last) {
    std::atomic<bool> whole{true};
    workers_.for_each(tiles.size(), 1, [&](WorkRange range) {
      const FlushDenormals flush;
      for (size_t i = range.begin; i < range.end; ++i) {
        if (progress_.cancelled()) {
          whole = false;
          return;
        }
        progress_.advance(trace(tiles[i], first, last, scratch_[static_cast<size_t>(range.worker)]));
        double none = 0;
        if (first == 0) first_tile_s_.compare_exchange_strong(none, clock_.seconds());
      }
    });
    return whole;
  }

  /// Seconds from the start of the loop until the first tile was done.
  double first_tile_s() const { return first_tile_s_; }

  void add_to(Statistics& statistics) const {
    statistics.samples_rejected += rejected_;
    for (const PathScratch& scratch : scratch_) {
      statistics.box_tests += scratch.thread.counts.box_tests;
      statistics.chunk_visits += scratch.thread.counts.chunk_visits;
      statistics.rays["camera"] += scratch.rays.camera;
      statistics.rays["shadow"] += scratch.rays.shadow;
      statistics.rays["indirect"] += scratch.rays.indirect;
    }
  }

 private:
  /// Returns how many samples it traced.
  double trace(const Tile& tile, uint32_t first, uint32_t last, PathScratch& scratch) {
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        for (uint32_t sample = first; sample < last; ++sample) {
          tracer_.trace(x, y, sample, scratch);
          if (!film_.add(x, y, scratch.sample, scratch.by_layer)) ++rejected_;
        }
      }
    }
    return static_cast<double>(tile.x1 - tile.x0) * (tile.y1 - tile.y0) * (last - first);
  }

  const PathTracer& tracer_;
  const Workers& workers_;
  Progress& progress_;
  Film& film_;
  std::vector<PathScratch> scratch_;  // one per worker
  std::atomic<int64_t> rejected_{0};
  const Stopwatch clock_;
  std::atomic<double> first_tile_s_{0};
};

}  // namespace

FrameResult render_frame(const RenderScene& scene, const Workers& workers, Progress& progress,
                         MemoryLedger& ledger, Statistics& statistics, const PathOptions& options) {
  const Stopwatch preparing;
  const FilmLayers layers = film_layers(scene);
  require_room(ledger, scene.render.memory.bytes,
               Film::bytes_needed(scene.image.width, scene.image.height, layers), "the film");
  FrameResult result{Film(scene.image.width, scene.image.height, layers, ledger)};
  const auto geometry = FrameGeometry::make(scene, workers, progress, ledger, statistics);
  result.partial = geometry == nullptr;
  if (result.partial) return result;

  const Stopwatch rendering;
  const PathTracer tracer(scene, geometry->accel(), result.film.layers(), options);
  const std::vector<Tile> tiles = tiles_along_curve(result.film.width(), result.film.height(), kTileSide);
  FrameLoop loop(tracer, workers, progress, result.film);
  const auto samples = static_cast<uint32_t>(scene.render.samples);
  progress.begin("render", static_cast<double>(result.film.width()) * result.film.height() * samples);
  while (result.samples < samples && !result.partial) {
    // Where chunks come and go, each tile is finished while what it needs is there.
    const bool stays = geometry->fits();
    const uint32_t next = stays ? std::min(samples, std::max(1u, 2 * result.samples)) : samples;
    const bool grows = stays && result.samples == 0;
    result.partial = !loop.pass(grows ? scattered(tiles) : tiles, result.samples, next);
    if (!result.partial) result.samples = next;
  }
  progress.end();
  loop.add_to(statistics);
  geometry->add_to(statistics);
  result.first_tile_s = preparing.seconds() - rendering.seconds() + loop.first_tile_s();
  statistics.stages_s["render"] += rendering.seconds();
  return result;
}

}  // namespace pelage
