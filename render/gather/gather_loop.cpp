// SPDX-License-Identifier: Apache-2.0
#include "render/gather/gather_loop.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/memory_budget.h"
#include "base/parallel.h"

namespace pelage {
namespace {

/// With so few samples, a first pass of one would find too few points that share light.
constexpr int kFew = 4;
/// Fraction of `render.memory` that tiles may take: 1 / kMemoryShare.
constexpr int64_t kMemoryShare = 8;

/// The tiles of the picture that a film stores. They are whole, also where a region ends inside of them: the
/// samples of a tile share light, so each pixel of a tile needs the others.
std::vector<Tile> tiles_of(const PixelBox& film) {
  std::vector<Tile> tiles = tiles_along_curve(film.width(), film.height(), GatherTile::kSide);
  for (Tile& tile : tiles)
    tile = {tile.x0 + film.x0, tile.y0 + film.y0, tile.x1 + film.x0, tile.y1 + film.y0};
  return tiles;
}

bool uses_cache(const RenderScene& scene) { return scene.render.uses_cache(scene.skins.size()); }

}  // namespace

GatherLoop::Memory GatherLoop::reserve_tiles(const RenderScene& scene, const Job& job) {
  const size_t lights = scene.lights.size();
  const uint32_t samples = GatherTile::samples_at_once(scene);
  const auto tile =
      static_cast<int64_t>(GatherTile::scratch_bytes(lights, samples, scene.render.draws_visible()));
  const auto limit = static_cast<int64_t>(scene.render.memory.bytes);
  int tiles = job.workers.thread_count();
  if (limit > 0) tiles = static_cast<int>(std::clamp<int64_t>(limit / kMemoryShare / tile, 1, tiles));
  const auto drawn =
      static_cast<int64_t>(scene.render.gather.reuse ? FarLightSamples::bytes(scene.lights) : 0);
  return {tiles,
          reserve(job.ledger, MemoryTag::kReflectionCache, tile * tiles + drawn,
                  "the sample buffer of the tiles that are rendered at once"),
          uses_cache(scene) ? std::optional(CacheFill::reserve(scene, job)) : std::nullopt};
}

GatherLoop::GatherLoop(const RenderScene& scene, const Accel& accel, const ResidentChunks& chunks,
                       const PathOptions& options, Memory& memory, bool fits, const Job& job,
                       const Stopwatch& clock, FrameResult& result, FrameWatch* watch, FrameSaver* saver)
    : scene_(scene),
      tile_(scene, accel, chunks, result.film.layers(), options, cache_),
      job_(job),
      clock_(clock),
      result_(result),
      watch_(watch),
      saver_(saver),
      in_passes_(fits || scene.render.time_limit > 0),
      first_alone_(scene.render.time_limit > 0 || scene.render.samples > kFew),
      refines_(watch && scene.render.time_limit <= 0),
      tiles_(tiles_of(result.window.film)),
      sample_counts_(tiles_.size()),
      free_(memory.tiles) {
  if (memory.cache) {
    fill_.emplace(scene, accel, result.film.layers().splat.has_value(), options, std::move(*memory.cache));
  }
  for (int i = 0; i < memory.tiles; ++i) {
    scratch_.push_back(tile_.make_scratch());
    idle_.push_back(scratch_.back().get());
  }
  if (saver_) saver_->restore(state());
}

FrameState GatherLoop::state() {
  FrameState blocks = result_.film.state();
  blocks.push_back(std::as_writable_bytes(std::span(sample_counts_)));
  return blocks;
}

size_t GatherLoop::tile_of(const Tile& tile) const {
  const PixelBox& film = result_.window.film;
  const int columns = (film.width() + GatherTile::kSide - 1) / GatherTile::kSide;
  return static_cast<size_t>((tile.y0 - film.y0) / GatherTile::kSide) * static_cast<size_t>(columns) +
         static_cast<size_t>((tile.x0 - film.x0) / GatherTile::kSide);
}

uint32_t GatherLoop::fitting(uint32_t count, uint32_t given) const {
  const float limit = scene_.render.time_limit;
  if (!(limit > 0) || given == 0) return count;
  const double fits = std::max(0.0, (limit - clock_.seconds()) / std::max(1e-9, sample_s_));
  return static_cast<uint32_t>(std::min<double>(fits, count));
}

uint32_t GatherLoop::portion(uint32_t first, uint32_t end) const {
  const uint32_t max = first == 0 && first_alone_ ? 1 : GatherTile::max_samples(scene_.lights.size());
  return std::min(max, end - first);
}

void GatherLoop::run() {
  if (fill_) fill_->run(job_, clock_, cache_);
  const auto samples = static_cast<uint32_t>(scene_.render.samples);
  const double pixels = static_cast<double>(result_.film.width()) * result_.film.height();
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double limit_s = scene_.render.time_limit > 0 ? double{scene_.render.time_limit} : kNever;
  job_.progress.begin("render", pixels * samples);
  for (const Tile& tile : tiles_)  // of a frame that was restored
    job_.progress.advance(1.0 * (tile.x1 - tile.x0) * (tile.y1 - tile.y0) * sample_counts_[tile_of(tile)]);
  PassEnd end = PassEnd::kDone;
  for (uint32_t given = 0; given < samples && end == PassEnd::kDone;) {
    const bool is_first = given == 0 && first_alone_ && in_passes_;
    const uint32_t wanted = in_passes_ ? portion(given, samples) : samples;
    const uint32_t count = fitting(wanted, given);
    if (count == 0) end = PassEnd::kOutOfTime;
    if (end == PassEnd::kDone) end = pass({given, count, is_first}, is_first ? kNever : limit_s);
    given += count;
    if (end == PassEnd::kDone) tell_watch();
    if (count < wanted && end == PassEnd::kDone) end = PassEnd::kOutOfTime;
  }
  job_.progress.end();
  if (end == PassEnd::kCancelled && saver_) saver_->save(state());
  report(end);
}

void GatherLoop::tell_watch() const {
  if (!watch_) return;
  double sum = 0;
  for (const uint32_t count : sample_counts_) sum += count;
  const uint32_t min = *std::min_element(sample_counts_.begin(), sample_counts_.end());
  watch_->passed(result_.film, {min, sum / static_cast<double>(sample_counts_.size()), 1, full_});
}

PassEnd GatherLoop::pass(const Pass& pass, double deadline_s) {
  while (true) {
    PassEnd end = refines_ ? refine_region() : PassEnd::kDone;
    if (end == PassEnd::kDone) end = trace(pass, pass.scattered ? scattered(tiles_) : tiles_, deadline_s);
    if (end != PassEnd::kDone || is_current()) return end;
  }
}

PassEnd GatherLoop::refine_region() {
  region_seen_ = watch_->region_version();
  const std::optional<PixelBox> region = watch_->region();
  const bool has_samples = *std::min_element(sample_counts_.begin(), sample_counts_.end()) > 0;
  if (!region || !has_samples) return PassEnd::kDone;
  std::vector<Tile> inside;
  const auto samples = static_cast<uint32_t>(scene_.render.samples);
  uint32_t first = samples;
  for (const Tile& tile : tiles_) {
    if (tile.x0 >= region->x1 || tile.x1 <= region->x0 || tile.y0 >= region->y1 || tile.y1 <= region->y0)
      continue;
    inside.push_back(tile);
    first = std::min(first, given(tile));
  }
  PassEnd end = PassEnd::kDone;
  while (first < samples && end == PassEnd::kDone && is_current()) {
    const uint32_t count = portion(first, samples);
    end = trace({first, count, false}, inside, std::numeric_limits<double>::infinity());
    first += count;
    full_ = *region;
    if (end == PassEnd::kDone && is_current()) tell_watch();
  }
  return end;
}

PassEnd GatherLoop::trace(const Pass& pass, const std::vector<Tile>& tiles, double deadline_s) {
  const double began = clock_.seconds();
  PassEnd end = PassEnd::kCancelled;
  while (true) {
    end = trace_tiles(tiles, job_, clock_, deadline_s, [&](const Tile& tile, int worker) {
      return !is_current() || trace_tile(pass, tile, worker);
    });
    if (end != PassEnd::kCancelled || !saver_ || job_.progress.cancelled()) break;
    saver_->save(state());
  }
  sample_s_ = (clock_.seconds() - began) / pass.count;
  return end;
}

/// A scratch that no other thread uses; waits until there is one.
class GatherLoop::Lease {
 public:
  explicit Lease(GatherLoop& loop) : loop_(loop) {
    loop_.free_.acquire();
    const std::scoped_lock lock(loop_.idle_mutex_);
    scratch_ = loop_.idle_.back();
    loop_.idle_.pop_back();
  }
  ~Lease() {
    {
      const std::scoped_lock lock(loop_.idle_mutex_);
      loop_.idle_.push_back(scratch_);
    }
    loop_.free_.release();
  }
  Lease(const Lease&) = delete;
  Lease& operator=(const Lease&) = delete;
  GatherTile::Scratch& scratch() { return *scratch_; }

 private:
  GatherLoop& loop_;
  GatherTile::Scratch* scratch_;
};

/// Takes the samples of the pass that the tile does not have yet. False when cancelled or when the state of
/// the frame should be saved.
bool GatherLoop::trace_tile(const Pass& pass, const Tile& tile, int worker) {
  uint32_t& first = given(tile);
  const uint32_t end = pass.first + pass.count;
  if (first >= end) return true;
  Lease lease(*this);
  const TileTimer timer(lease.scratch().costs);
  lease.scratch().thread.worker = worker;
  while (first < end) {
    if (saver_ && saver_->due()) return false;
    const uint32_t count = portion(first, end);
    if (!tile_.trace(tile, first, count, job_, lease.scratch())) return false;
    land(count, tile, lease.scratch());
    first += count;
  }
  return true;
}

void GatherLoop::land(uint32_t count, const Tile& tile, GatherTile::Scratch& scratch) {
  rejected_ += tile_.add_to(result_.window.film, result_.film, scratch);
  scratch.gather_points +=
      {.gather_points = static_cast<int64_t>(scratch.samples.zone_of_gather_point.size()),
       .samples = static_cast<int64_t>(scratch.samples.points.size())};
  job_.progress.advance(static_cast<double>(count) * (tile.x1 - tile.x0) * (tile.y1 - tile.y0));
  double none = 0;
  if (first_tile_s_ == 0) first_tile_s_.compare_exchange_strong(none, clock_.seconds());
}

TileCosts GatherLoop::costs() const {
  TileCosts all;
  for (const auto& scratch : scratch_) all += scratch->costs;
  if (fill_) all += fill_->costs();
  return all;
}

void GatherLoop::report(PassEnd end) {
  result_.partial = end == PassEnd::kCancelled;
  result_.time_limited = end == PassEnd::kOutOfTime;
  result_.first_tile_s = first_tile_s_;
  result_.samples = result_.film.samples(0, 0);
  double sum = 0;
  for (int y = 0; y < result_.film.height(); ++y) {
    for (int x = 0; x < result_.film.width(); ++x) {
      result_.samples = std::min(result_.samples, result_.film.samples(x, y));
      sum += result_.film.samples(x, y);
    }
  }
  result_.mean_samples = sum / (static_cast<double>(result_.film.width()) * result_.film.height());
  result_.statistics.samples_rejected += rejected_;
  for (const auto& scratch : scratch_) {
    result_.statistics.gather_points += scratch->gather_points;
    result_.statistics.reflections += scratch->indirect_paths.reflections;
  }
  IndirectClamp clamp;
  for (const auto& scratch : scratch_) {
    result_.statistics.trace += scratch->thread.counts;
    clamp.add_counts(scratch->clamp);
  }
  if (fill_) fill_->add_to(result_.statistics);
  for (const auto& scratch : scratch_) result_.statistics.rays += scratch->costs.rays.counts();
  result_.clamped_fraction = clamp.lost_fraction();
}

}  // namespace pelage
