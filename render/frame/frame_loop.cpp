// SPDX-License-Identifier: Apache-2.0
#include "render/frame/frame_loop.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "base/parallel.h"

namespace pelage {
namespace {

constexpr int kTileSide = FilmSums::kTileSide;

int tile_count(int pixels) { return (pixels + kTileSide - 1) / kTileSide; }

PixelBox moved(const PixelBox& box, int x, int y) { return {box.x0 + x, box.y0 + y, box.x1 + x, box.y1 + y}; }

/// The tiles of a film, cut off at the border of the traced pixels.
std::vector<Tile> tiles_within(const PixelBox& traced, const Film& film) {
  std::vector<Tile> tiles;
  for (const Tile& tile : tiles_along_curve(film.width(), film.height(), kTileSide)) {
    const Tile part{std::max(tile.x0, traced.x0), std::max(tile.y0, traced.y0), std::min(tile.x1, traced.x1),
                    std::min(tile.y1, traced.y1)};
    if (part.x0 < part.x1 && part.y0 < part.y1) tiles.push_back(part);
  }
  return tiles;
}

}  // namespace

FrameLoop::FrameLoop(const SampleIntegrator& integrator, const Job& job, Film& film,
                     const FrameWindow& window, const Stopwatch& clock, FrameSaver* saver)
    : integrator_(integrator),
      job_(job),
      film_(film),
      left_(window.film.x0),
      top_(window.film.y0),
      traced_(moved(window.traced, -left_, -top_)),
      clock_(clock),
      saver_(saver),
      tiles_(tiles_within(traced_, film)),
      costs_(static_cast<size_t>(tile_count(film.width())) * static_cast<size_t>(tile_count(film.height()))),
      sample_counts_(static_cast<size_t>(film.width()) * static_cast<size_t>(film.height())) {
  for (int worker = 0; worker < job.workers.thread_count(); ++worker) {
    scratch_.push_back(integrator.make_scratch());
    scratch_.back()->thread.worker = worker;
  }
  if (saver_) saver_->restore(state());
}

FrameState FrameLoop::state() {
  FrameState blocks = film_.state();
  blocks.push_back(std::as_writable_bytes(std::span(sample_counts_)));
  return blocks;
}

uint32_t FrameLoop::min_samples() const {
  uint32_t min = std::numeric_limits<uint32_t>::max();
  for (int y = traced_.y0; y < traced_.y1; ++y) {
    for (int x = traced_.x0; x < traced_.x1; ++x) min = std::min(min, sample_counts_[pixel_of(x, y)]);
  }
  return min;
}

double FrameLoop::mean_samples() const {
  return std::accumulate(sample_counts_.begin(), sample_counts_.end(), 0.0) /
         static_cast<double>(traced_count());
}

PassEnd FrameLoop::pass(const Goal& goal, bool scattered, double deadline_s) {
  const std::vector<Tile> tiles = scattered ? pelage::scattered(tiles_) : tiles_;
  while (true) {
    const PassEnd end = trace_tiles(tiles, job_, clock_, deadline_s, [&](const Tile& tile, int worker) {
      if (saver_ && saver_->due()) return false;
      if (!trace(tile, goal, *scratch_[static_cast<size_t>(worker)])) return false;
      double none = 0;
      if (first_tile_s_ == 0) first_tile_s_.compare_exchange_strong(none, clock_.seconds());
      return true;
    });
    if (end != PassEnd::kCancelled || !saver_ || job_.progress.cancelled()) return end;
    saver_->save(state());
  }
}

uint32_t FrameLoop::min_samples(const Tile& tile) const {
  uint32_t min = std::numeric_limits<uint32_t>::max();
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) min = std::min(min, sample_counts_[pixel_of(x, y)]);
  }
  return min;
}

bool FrameLoop::trace(const Tile& tile, const Goal& goal, SampleScratch& scratch) {
  const TileTimer timer(scratch.costs);
  const double began = clock_.seconds();
  int64_t traced = 0;
  // Splatted samples of several pixels enter the same sum. They are traced sample by sample, so that the
  // order of the sum does not depend on how many samples a pass takes.
  // If they were interrupted within a sample, the pixels that lack it come first.
  const bool splatted = film_.layers().splat.has_value();
  constexpr uint32_t kAll = std::numeric_limits<uint32_t>::max();
  const uint32_t at_once = splatted ? 1 : kAll;
  bool stopped = false;
  for (bool more = true; more && !stopped;) {
    more = false;
    const uint32_t fewest = splatted ? min_samples(tile) : kAll;
    for (int y = tile.y0; y < tile.y1 && !stopped; ++y) {
      for (int x = tile.x0; x < tile.x1 && !stopped; ++x) {
        uint32_t& given = sample_counts_[pixel_of(x, y)];
        if (given > fewest) continue;
        const uint32_t before = given;
        stopped = !trace_pixel(x, y, goal, at_once, given, scratch);
        traced += given - before;
        more = more || (splatted && given > before);
      }
    }
  }
  TileCost& cost = costs_[tile_of(tile.x0, tile.y0)];
  cost.seconds += clock_.seconds() - began;
  cost.samples += static_cast<double>(traced);
  job_.progress.advance(static_cast<double>(traced));
  return !stopped;
}

bool FrameLoop::trace_pixel(int x, int y, const Goal& goal, uint32_t at_once, uint32_t& given,
                            SampleScratch& scratch) {
  constexpr uint32_t kSamplesPerCheck = 16;  // samples: a tile of many takes minutes
  const size_t pixel = pixel_of(x, y);
  uint32_t left = at_once;
  for (uint32_t until = goal(pixel, given); left > 0 && given < until; until = goal(pixel, given)) {
    for (; left > 0 && given < until; ++given, --left) {
      const bool checks = given % kSamplesPerCheck == 0;
      if (checks && (job_.progress.cancelled() || (saver_ && saver_->due()))) return false;
      integrator_.trace(left_ + x, top_ + y, given, scratch);
      if (!film_.add(x, y, scratch.sample, scratch.by_layer)) ++rejected_;
    }
  }
  return true;
}

size_t FrameLoop::tile_of(int x, int y) const {
  return static_cast<size_t>(y / kTileSide) * static_cast<size_t>(tile_count(width())) +
         static_cast<size_t>(x / kTileSide);
}

double FrameLoop::cost(size_t pixel) const {
  const auto columns = static_cast<size_t>(width());
  const TileCost& tile =
      costs_[tile_of(static_cast<int>(pixel % columns), static_cast<int>(pixel / columns))];
  return tile.samples > 0 ? tile.seconds / tile.samples : 0;
}

TileCosts FrameLoop::costs() const {
  TileCosts all;
  for (const auto& scratch : scratch_) all += scratch->costs;
  return all;
}

void FrameLoop::add_to(FrameStatistics& statistics) const {
  statistics.samples_rejected += rejected_;
  for (const auto& scratch : scratch_) statistics.trace += scratch->thread.counts;
  statistics.rays += costs().rays.counts();
}

double FrameLoop::clamped_fraction() const {
  IndirectClamp all;
  for (const auto& scratch : scratch_) all.add_counts(scratch->clamp);
  return all.lost_fraction();
}

}  // namespace pelage
