// SPDX-License-Identifier: Apache-2.0
#include "render/frame/frame_loop.h"

#include <algorithm>

#include "base/parallel.h"
#include "render/sampling/adaptive_rule.h"

namespace pelage {
namespace {

constexpr int kTileSide = FilmSums::kTileSide;

int tile_count(int pixels) { return (pixels + kTileSide - 1) / kTileSide; }

PixelBox moved(const PixelBox& box, int x, int y) { return {box.x0 + x, box.y0 + y, box.x1 + x, box.y1 + y}; }

PixelBox traced_pixels(const TileIntegrator& integrator, const Film& film, const FrameWindow& window) {
  if (integrator.shares_light()) return {0, 0, film.width(), film.height()};
  return moved(window.traced, -window.film.x0, -window.film.y0);
}

std::vector<std::unique_ptr<SampleScratch>> make_scratch(const TileIntegrator& integrator, int count) {
  std::vector<std::unique_ptr<SampleScratch>> all;
  for (int i = 0; i < count; ++i) all.push_back(integrator.make_scratch());
  return all;
}

}  // namespace

FrameLoop::FrameLoop(const TileIntegrator& integrator, const Job& job, Film& film, const FrameWindow& window,
                     const Stopwatch& clock, FrameSaver* saver)
    : integrator_(integrator),
      job_(job),
      film_(film),
      left_(window.film.x0),
      top_(window.film.y0),
      traced_(traced_pixels(integrator, film, window)),
      clock_(clock),
      saver_(saver),
      tile_costs_(static_cast<size_t>(tile_count(film.width())) *
                  static_cast<size_t>(tile_count(film.height()))),
      scratch_(make_scratch(integrator, integrator.max_tiles(job.workers.thread_count()))) {
  if (saver_) saver_->restore(state());
}

uint32_t FrameLoop::pass_end(uint32_t given, uint32_t wanted, uint32_t max) const {
  while (given < std::min(wanted, max)) given += integrator_.together(given, max);
  return given;
}

std::vector<Tile> FrameLoop::tiles(const std::optional<PixelBox>& region) const {
  std::vector<Tile> result;
  for (const Tile& tile : tiles_along_curve(film_.width(), film_.height(), kTileSide)) {
    const Tile traced = intersection(tile, traced_);
    const Tile chosen = region ? intersection(traced, *region) : traced;
    if (chosen.is_empty()) continue;
    result.push_back(links_pixels() ? traced : chosen);
  }
  return result;
}

PassEnd FrameLoop::pass(const Pass& pass) {
  std::vector<Tile> tiles = this->tiles(pass.region);
  if (pass.scattered) tiles = scattered(tiles);
  weigh(tiles, pass.goal);
  const TaskFrame frame{film_,
                        left_,
                        top_,
                        pass.goal,
                        job_,
                        saver_,
                        pass.interrupts,
                        [this](const Tile& tile, uint64_t samples) { advance(tile, samples); }};
  while (true) {
    const PassEnd end = trace_tiles(tiles, job_, clock_, pass.deadline_s, [&](const Tile& tile, int worker) {
      return trace({frame, tile}, worker);
    });
    if (end != PassEnd::kCancelled || job_.progress.cancelled()) return end;
    if (pass.interrupts && pass.interrupts()) return PassEnd::kInterrupted;
    if (!saver_) return end;
    saver_->save(state());
  }
}

void FrameLoop::weigh(const std::vector<Tile>& tiles, const SampleGoal& goal) {
  weights_.assign(tile_costs_.size(), 1);
  std::vector<double> costs = weights_;
  double samples = 0, seconds = 0;
  for (const Tile& tile : tiles) {
    const size_t index = tile_index(tile.x0, tile.y0);
    const TileCost& cost = tile_costs_[index];
    if (!(cost.samples > 0 && cost.seconds > 0)) return;
    costs[index] = cost.seconds / cost.samples;
    double missing = 0;
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        const uint32_t wanted =
            goal(static_cast<size_t>(y) * static_cast<size_t>(film_.width()) + static_cast<size_t>(x));
        missing += wanted - std::min(wanted, film_.samples(x, y));
      }
    }
    samples += missing;
    seconds += missing * costs[index];
  }
  if (!(seconds > 0)) return;
  for (double& cost : costs) cost *= samples / seconds;
  weights_ = std::move(costs);
}

bool FrameLoop::trace(const TileTask& task, int worker) {
  if (task.must_stop()) return false;
  const ScratchPool::Lease lease(scratch_, worker);
  const TileTimer timer(lease.scratch().costs);
  const double began = clock_.seconds();
  const bool finished = integrator_.trace_tile(task, lease.scratch());
  tile_costs_[tile_index(task.tile.x0, task.tile.y0)].seconds += clock_.seconds() - began;
  return finished;
}

void FrameLoop::advance(const Tile& tile, uint64_t samples) {
  tile_costs_[tile_index(tile.x0, tile.y0)].samples += static_cast<double>(samples);
  job_.progress.advance(static_cast<double>(samples) * weights_[tile_index(tile.x0, tile.y0)]);
  double none = 0;
  if (first_tile_s_ == 0) first_tile_s_.compare_exchange_strong(none, clock_.seconds());
}

size_t FrameLoop::tile_index(int x, int y) const {
  return static_cast<size_t>(y / kTileSide) * static_cast<size_t>(tile_count(film_.width())) +
         static_cast<size_t>(x / kTileSide);
}

double FrameLoop::cost(size_t pixel) const {
  const auto columns = static_cast<size_t>(film_.width());
  const TileCost& tile =
      tile_costs_[tile_index(static_cast<int>(pixel % columns), static_cast<int>(pixel / columns))];
  return tile.samples > 0 ? tile.seconds / tile.samples : 0;
}

TileCosts FrameLoop::costs() const {
  TileCosts all;
  for (const auto& scratch : scratch_.all()) all += scratch->costs;
  return all;
}

void FrameLoop::add_to(FrameStatistics& statistics) const {
  for (const auto& scratch : scratch_.all()) scratch->add_to(statistics);
}

void FrameLoop::report(FrameResult& result) const {
  result.samples = min_samples();
  result.mean_samples = mean_samples();
  result.noise = frame_noise(film_.moments());
  result.first_tile_s = first_tile_s_;
  IndirectClamp clamp;
  for (const auto& scratch : scratch_.all()) clamp.add_counts(scratch->clamp);
  result.clamped_fraction = clamp.lost_fraction();
  add_to(result.statistics);
}

}  // namespace pelage
