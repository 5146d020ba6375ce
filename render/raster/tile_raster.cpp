// SPDX-License-Identifier: Apache-2.0
#include "render/raster/tile_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/process_usage.h"
#include "render/raster/segment_cell_view.h"
#include "render/raster/tile_drawing.h"

namespace pelage {
namespace {

constexpr size_t kCandidates = 64;  // found at once
/// Lines with a larger angle to the axis of their tile, as a tangent, are traced.
constexpr float kMaxSlope = 0.5f;
/// Before all chunks.
constexpr TileRaster::Scratch::Candidate kFirst{-std::numeric_limits<float>::infinity(), 0};

/// The range of depths of a box.
Range depths_of(const TileFrame& frame, const Box3f& box) {
  constexpr float kFarthest = 1e18f;
  const V3f size = box.size();
  if (!std::isfinite(size.x + size.y + size.z)) return {-kFarthest, kFarthest};
  const float middle = frame.local(box.center()).z;
  const float half = 0.5f * BeamPlane{frame.axes[2], 0}.spread(box.size());
  return Range{middle - half, middle + half}.widened(1e-5f * (std::abs(middle) + half));
}

/// Where the lines of a pixel are close.
float reference_depth(const FrameScene& scene, const Accel& accel, const TileFrame& frame, float focus) {
  if (scene.camera.has_lens()) return focus;
  const Box3f all = accel.bounds();
  return all.isEmpty() ? 1.0f : std::max(frame.local(all.center()).z, 0.0f);
}

}  // namespace

size_t TileRaster::scratch_bytes(size_t samples) {
  return StrandCache::bytes_bound() + samples * (sizeof(CameraSample) + sizeof(TileLine)) +
         TileLines::bytes(samples) + TileHits::bytes(samples) +
         2 * (kCandidates + 1) * sizeof(Scratch::Candidate);
}

TileRaster::View TileRaster::make_lines(const Tile& tile, uint32_t first, uint32_t count,
                                        Scratch& scratch) const {
  const CameraRay axis = scene_.camera.ray(0.5f * static_cast<float>(tile.x0 + tile.x1),
                                           0.5f * static_cast<float>(tile.y0 + tile.y1), V2f(0.5f), 0.5f);
  View view;
  view.frame = TileFrame::along(axis.origin, axis.direction);
  const size_t total =
      static_cast<size_t>(tile.x1 - tile.x0) * static_cast<size_t>(tile.y1 - tile.y0) * count;
  scratch.samples.resize(total);
  scratch.drawn.resize(total);
  size_t slot = 0;
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      for (uint32_t i = 0; i < count; ++i, ++slot) {
        SampleStream stream = camera_.stream(x, y, first + i);
        const CameraSample sample = camera_.sample(x, y, first + i, stream);
        scratch.samples[slot] = sample;
        const Ray& ray = sample.ray;
        const V3f from = view.frame.local(ray.origin), along = view.frame.rotated(ray.direction);
        TileLine& line = scratch.drawn[slot];
        line.b = V2f(along.x, along.y) * (1 / std::max(along.z, 1e-6f));
        line.a = V2f(from.x, from.y) - from.z * line.b;
        line.time = ray.time;
        line.random = ray.random;
        view.possible =
            view.possible && along.z > 0 && std::max(std::abs(line.b.x), std::abs(line.b.y)) <= kMaxSlope;
        view.starts.extend(from.z);
      }
    }
  }
  const float focus = scene_.camera.lod_view().focus_distance * axis.direction.dot(scene_.camera.axis(0.5f));
  view.reference = reference_depth(scene_, accel_, view.frame, focus);
  return view;
}

/// Sorts the lines. `depths`: of everything that may be seen.
void TileRaster::sort_lines(const View& view, const Range& depths, Scratch& scratch) const {
  scratch.lines.assign(scratch.drawn, view.reference);
  if (!scratch.lines.has_lens()) return;
  const TileBeam beam(view.frame, scratch.lines, view.starts.low, view.starts.low, depths.high);
  find_candidates({true, false}, beam.beam(), depths.high, {kFirst, kFirst}, scratch);
  if (scratch.candidates[kFur].empty()) return;
  const Box3f& nearest = chunks_.boxes().whole(scratch.candidates[kFur].front().chunk);
  const int parts = scratch.lines.lens_parts(depths_of(view.frame, nearest));
  if (parts > 1) scratch.lines.assign(scratch.drawn, view.reference, parts);
}

bool TileRaster::find(const Tile& tile, uint32_t first, uint32_t count, const Job& job, int worker,
                      Scratch& scratch) const {
  scratch.samples_per_pixel = count;
  scratch.growth_s = 0;
  const View view = make_lines(tile, first, count, scratch);
  const Box3f bounds = accel_.bounds();
  const Range all = bounds.isEmpty() ? Range{0, 0} : depths_of(view.frame, bounds);
  sort_lines(view, all, scratch);
  if (!bounds.isEmpty() && !draw_all(view, all, job, worker, scratch)) return false;
  return find_hits(job, worker, scratch);
}

/// `all`: the depths of everything. Returns false when cancelled.
bool TileRaster::draw_all(const View& view, const Range& all, const Job& job, int worker,
                          Scratch& scratch) const {
  bool possible = view.possible;
  TileDrawing drawing(view.frame, view.starts, scratch.lines);
  const TileBeam beam = drawing.beam(all);
  Candidates done{kFirst, kFirst};
  find_candidates({true, true}, beam.beam(), drawing.far(), done, scratch);
  // Skins hide what is behind them, and are quickly drawn.
  for (const ChunkKind kind : {kSkin, kFur}) {
    for (;;) {
      for (const Scratch::Candidate& next : scratch.candidates[kind]) {
        if (job.progress.cancelled()) return false;
        done[kind] = next;
        drawing.update();
        if (!possible || !may_be_seen(next.chunk, drawing)) continue;
        const Range depths = depths_of(view.frame, seen_box(chunks_.boxes().whole(next.chunk)));
        grow(next.chunk, worker, scratch);
        possible = chunks_.visit(next.chunk, worker, [&](const ChunkGeometry& geometry) {
          return drawing.draw(geometry, next.chunk, depths);
        });
      }
      if (scratch.candidates[kind].size() < kCandidates) break;
      find_candidates({kind == kFur, kind == kSkin}, beam.beam(), drawing.far(), done, scratch);
    }
  }
  if (!possible) scratch.lines.trace_all();
  return true;
}

/// Intersects the rays of samples with the segments that were drawn, chunk by chunk, and copies the strands
/// while their chunk is there. Returns false when cancelled.
bool TileRaster::find_hits(const Job& job, int worker, Scratch& scratch) const {
  scratch.hits.begin(scratch.lines, [&](uint32_t chunk) { return !chunks_.is_skin(chunk); });
  scratch.held.begin();
  for (size_t first = 0;;) {
    const std::span<TileHits::Group> groups = scratch.hits.chunk(first);
    if (groups.empty()) return true;
    if (job.progress.cancelled()) return false;
    const uint32_t chunk = groups[0].chunk;
    grow(chunk, worker, scratch);
    chunks_.visit(chunk, worker, [&](const ChunkGeometry& geometry) {
      for (TileHits::Group& group : groups) {
        scratch.hits.find(geometry, group, scratch.samples);
        if (!group.hit) continue;
        scratch.held.keep(group.hit.handle(),
                          [&](Strands& out) { geometry.strand(group.hit.strand_index, out); });
      }
    });
    if (std::any_of(groups.begin(), groups.end(), [](const auto& group) { return bool(group.hit); }))
      chunks_.mark_hit(chunk);
    first += groups.size();
  }
}

/// Grows a chunk that is not resident, and measures the time.
void TileRaster::grow(uint32_t chunk, int worker, Scratch& scratch) const {
  if (chunks_.is_resident(chunk)) return;
  const double before_s = thread_cpu_seconds();
  chunks_.visit(chunk, worker, [](const ChunkGeometry&) {});
  scratch.growth_s += thread_cpu_seconds() - before_s;
}

/// Finds, for each wanted kind, the first chunks after one, in the order of their least depth.
void TileRaster::find_candidates(std::array<bool, 2> wanted, const Beam& beam, float far,
                                 const Candidates& after, Scratch& scratch) const {
  for (const size_t kind : {kFur, kSkin}) {
    if (wanted[kind]) scratch.candidates[kind].clear();
  }
  for (uint32_t chunk = 0; chunk < chunks_.size(); ++chunk) {
    const size_t kind = chunks_.is_skin(chunk) ? kSkin : kFur;
    Scratch::Candidate candidate{0, chunk};
    if (!wanted[kind] || !beam.meets(seen_box(chunks_.boxes().whole(chunk)), far, candidate.entry) ||
        !(after[kind] < candidate))
      continue;
    auto& candidates = scratch.candidates[kind];
    candidates.push_back(candidate);
    std::push_heap(candidates.begin(), candidates.end());
    if (candidates.size() <= kCandidates) continue;
    std::pop_heap(candidates.begin(), candidates.end());
    candidates.pop_back();
  }
  for (const size_t kind : {kFur, kSkin}) {
    if (wanted[kind]) std::sort_heap(scratch.candidates[kind].begin(), scratch.candidates[kind].end());
  }
}

/// Whether lines may see the chunk. Does not depend on whether the chunk is resident: pieces are a little
/// wider than strands, so drawing a chunk whose boxes are hidden could change which samples are traced.
bool TileRaster::may_be_seen(uint32_t chunk, const TileDrawing& drawing) const {
  if (!drawing.may_see(seen_box(chunks_.boxes().whole(chunk)))) return false;
  return !chunks_.boxes().has_cell_bounds(chunk) || segment_cell_bounds_may_be_seen(chunk, drawing);
}

bool TileRaster::segment_cell_bounds_may_be_seen(uint32_t chunk, const TileDrawing& drawing) const {
  const SegmentCellBounds& cell_bounds = chunks_.boxes().cell_bounds(chunk);
  // No strand of the chunk is widened more than one at the farthest point of its box.
  const Box3f& whole = chunks_.boxes().whole(chunk);
  const float wider = whole.isEmpty() ? 0 : whole.min.x - seen_box(whole).min.x;
  const SegmentCellView view(drawing.frame(), cell_bounds.grid(),
                             chunks_.boxes().margin(chunk) + 1.001f * wider);
  if (!view.is_finite()) return true;
  // Three siblings wait on each level below the highest; 2^32 boxes have 16 levels.
  struct {
    size_t level, group;
  } stack[64];
  size_t waiting = 0;
  stack[waiting++] = {cell_bounds.levels() - 1, 0};
  while (waiting > 0) {
    const auto [level, at] = stack[--waiting];
    const SegmentCellBounds::Group& group = cell_bounds.level(level)[at];
    const std::array<bool, 4> seen = drawing.may_see(view(group));
    for (size_t lane = 4; lane-- > 0;) {
      if (!seen[lane] || !SegmentCellView::exists(group, lane)) continue;
      if (level == 0) return true;
      stack[waiting++] = {level - 1, 4 * at + lane};
    }
  }
  return false;
}

Hit TileRaster::closest(uint32_t pixel, uint32_t sample, TraceThread& thread, Scratch& scratch) const {
  const size_t at = slot(pixel, sample, scratch);
  if (const std::optional<Hit> hit = drawn_hit(at, thread, scratch)) return *hit;
  ++scratch.traced;
  scratch.held.take_back(thread.hit_geometry.strand);
  return accel_.closest(scratch.samples[at].ray, thread);
}

/// Returns nothing if the ray must be traced.
std::optional<Hit> TileRaster::drawn_hit(size_t slot, TraceThread& thread, Scratch& scratch) const {
  const TileWinner winner = scratch.lines.winner(slot);
  if (winner.chunk == TileWinner::kNothing) return Hit();
  if (winner.chunk == TileWinner::kTraced) return std::nullopt;
  const auto visit = [&](const auto& use) {
    if (!chunks_.is_resident(winner.chunk)) ++thread.counts.absent_visits;
    chunks_.visit(winner.chunk, thread.worker, use);
  };
  if (chunks_.is_skin(winner.chunk)) {
    NearestSoFar nearest;
    FurRays rays;
    visit([&](const ChunkGeometry& geometry) {
      geometry.closest(scratch.samples[slot].ray, rays, nearest, thread.hit_geometry);
    });
    if (!nearest.hit) return std::nullopt;
    chunks_.mark_hit(winner.chunk);
    return nearest.hit;
  }
  const Hit hit = scratch.hits.hit(slot);
  if (!hit) return std::nullopt;
  scratch.held.lend(hit.handle(), thread.hit_geometry.strand, [&](Strands& out) {
    visit([&](const ChunkGeometry& geometry) { geometry.strand(hit.strand_index, out); });
  });
  return hit;
}

}  // namespace pelage
