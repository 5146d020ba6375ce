// SPDX-License-Identifier: Apache-2.0
#include "render/raster/tile_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/process_usage.h"
#include "render/raster/tile_drawing.h"

namespace pelage {
namespace {

constexpr size_t kCandidates = 64;  // found at once
/// Lines with a larger angle to the axis of their tile, as a tangent, are traced.
constexpr float kMaxSlope = 0.5f;

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
float reference_depth(const RenderScene& scene, const Accel& accel, const TileFrame& frame, float focus) {
  if (scene.camera.has_lens()) return focus;
  const Box3f all = accel.bounds();
  return all.isEmpty() ? 1.0f : std::max(frame.local(all.center()).z, 0.0f);
}

}  // namespace

size_t TileRaster::scratch_bytes(size_t samples) {
  return HeldStrands::bytes_bound() + samples * sizeof(TileLine) + TileLines::bytes(samples) +
         (kCandidates + 1) * sizeof(Scratch::Candidate);
}

TileRaster::View TileRaster::make_lines(const Tile& tile, uint32_t first, uint32_t count,
                                        Scratch& scratch) const {
  const CameraRay axis = scene_.camera.ray(0.5f * static_cast<float>(tile.x0 + tile.x1),
                                           0.5f * static_cast<float>(tile.y0 + tile.y1), V2f(0.5f), 0.5f);
  View view;
  view.frame = TileFrame::along(axis.origin, axis.direction);
  scratch.drawn.clear();
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      for (uint32_t i = 0; i < count; ++i) {
        SampleStream stream = camera_.stream(x, y, first + i);
        const Ray ray = camera_.draw(x, y, first + i, stream).ray;
        const V3f from = view.frame.local(ray.origin), along = view.frame.rotated(ray.direction);
        TileLine line;
        line.b = V2f(along.x, along.y) * (1 / std::max(along.z, 1e-6f));
        line.a = V2f(from.x, from.y) - from.z * line.b;
        line.time = ray.time;
        line.random = ray.random;
        view.possible =
            view.possible && along.z > 0 && std::max(std::abs(line.b.x), std::abs(line.b.y)) <= kMaxSlope;
        view.starts.extend(from.z);
        scratch.drawn.push_back(line);
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
  find_candidates(false, beam.beam(), depths.high, {-std::numeric_limits<float>::infinity(), 0}, scratch);
  if (scratch.candidates.empty()) return;
  const Box3f& nearest = chunks_.boxes().whole(scratch.candidates.front().chunk);
  const int parts = scratch.lines.lens_parts(depths_of(view.frame, nearest));
  if (parts > 1) scratch.lines.assign(scratch.drawn, view.reference, parts);
}

bool TileRaster::find(const Tile& tile, uint32_t first, uint32_t count, const Job& job, int worker,
                      Scratch& scratch) const {
  scratch.samples_per_pixel = count;
  scratch.growth_s = 0;
  const View view = make_lines(tile, first, count, scratch);
  const ChunkBoxes& boxes = chunks_.boxes();
  const Box3f bounds = accel_.bounds();
  const Range all = bounds.isEmpty() ? Range{0, 0} : depths_of(view.frame, bounds);
  sort_lines(view, all, scratch);
  if (bounds.isEmpty()) return true;
  bool possible = view.possible;
  TileDrawing drawing(view.frame, view.starts, scratch.lines);
  const TileBeam beam = drawing.beam(all);
  // Skins hide what is behind them, and are quickly drawn.
  for (const bool skins : {true, false}) {
    Scratch::Candidate done{-std::numeric_limits<float>::infinity(), 0};
    do {
      find_candidates(skins, beam.beam(), drawing.far(), done, scratch);
      for (const Scratch::Candidate& next : scratch.candidates) {
        if (job.progress.cancelled()) return false;
        done = next;
        drawing.update();
        if (!possible || !may_be_seen(next.chunk, drawing)) continue;
        const Range depths = depths_of(view.frame, seen_box(boxes.whole(next.chunk)));
        if (!chunks_.is_resident(next.chunk)) {
          const double before_s = thread_cpu_seconds();
          chunks_.visit(next.chunk, worker, [](const ChunkGeometry&) {});
          scratch.growth_s += thread_cpu_seconds() - before_s;
        }
        possible = chunks_.visit(next.chunk, worker, [&](const ChunkGeometry& geometry) {
          return drawing.draw(geometry, next.chunk, depths);
        });
      }
    } while (scratch.candidates.size() == kCandidates);
  }
  if (!possible) scratch.lines.trace_all();
  return true;
}

/// The first chunks after one, in the order of their least depth.
void TileRaster::find_candidates(bool skins, const Beam& beam, float far, const Scratch::Candidate& after,
                                 Scratch& scratch) const {
  auto& candidates = scratch.candidates;
  candidates.clear();
  for (uint32_t chunk = 0; chunk < chunks_.size(); ++chunk) {
    Scratch::Candidate candidate{0, chunk};
    if (chunks_.is_skin(chunk) != skins ||
        !beam.meets(seen_box(chunks_.boxes().whole(chunk)), far, candidate.entry) || !(after < candidate))
      continue;
    candidates.push_back(candidate);
    std::push_heap(candidates.begin(), candidates.end());
    if (candidates.size() <= kCandidates) continue;
    std::pop_heap(candidates.begin(), candidates.end());
    candidates.pop_back();
  }
  std::sort_heap(candidates.begin(), candidates.end());
}

/// Whether lines may see the chunk.
bool TileRaster::may_be_seen(uint32_t chunk, const TileDrawing& drawing) const {
  const ChunkBoxes& boxes = chunks_.boxes();
  if (!drawing.may_see(seen_box(boxes.whole(chunk)))) return false;
  // The tree of a resident chunk is faster than its fine boxes.
  if (chunks_.is_resident(chunk) || !boxes.has_fine(chunk)) return true;
  const FineBoxes& fine = boxes.fine(chunk);
  const V3f margin(boxes.margin(chunk));
  for (size_t b = 0; b < fine.count(); ++b) {
    Box3f box = fine.box(b, 0);
    box.extendBy(fine.box(b, 1));
    if (drawing.may_see(seen_box({box.min - margin, box.max + margin}))) return true;
  }
  return false;
}

Hit TileRaster::closest(uint32_t pixel, uint32_t sample, const Ray& ray, TraceThread& thread,
                        Scratch& scratch) const {
  const TileWinner winner = scratch.lines.winner(size_t{pixel} * scratch.samples_per_pixel + sample);
  if (winner.chunk == TileWinner::kNothing) return {};
  if (winner.chunk != TileWinner::kTraced) {
    NearestSoFar nearest;
    FurRays rays;
    if (!chunks_.is_resident(winner.chunk)) ++thread.counts.absent_visits;
    const bool found = chunks_.visit(winner.chunk, thread.worker, [&](const ChunkGeometry& geometry) {
      if (!geometry.closest_at(ray, winner.primitive, rays, nearest, thread.met)) return false;
      if (const StrandHandle strand = nearest.hit.handle()) {
        scratch.held.lend(strand, thread.met.strand,
                          [&](Strands& out) { geometry.strand(strand.index, out); });
      }
      return true;
    });
    if (found) {
      chunks_.mark_hit(winner.chunk);
      return nearest.hit;
    }
  }
  ++scratch.traced;
  scratch.held.take_back(thread.met.strand);
  return accel_.closest(ray, thread);
}

}  // namespace pelage
