// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/job.h"
#include "render/accel/accel.h"
#include "render/accel/min_width.h"
#include "render/accel/resident_chunks.h"
#include "render/frame/camera_samples.h"
#include "render/frame/tile_order.h"
#include "render/raster/strand_cache.h"
#include "render/raster/tile_frame.h"
#include "render/raster/tile_hits.h"
#include "render/raster/tile_lines.h"
#include "render/scene/frame_scene.h"

namespace pelage {

class TileDrawing;

/// Finds what the camera samples of a tile see, by drawing strands and skins instead of tracing a ray per
/// sample. Drawing decides which primitive each sample sees. Then the ray of the sample is intersected with
/// this primitive only. If the ray misses it, closest() traces the ray. So every result is a hit of the ray,
/// and nearly always the nearest.
///
/// The result depends only on the scene, the tile and the indices of its samples. It does not depend on which
/// chunks are resident, or on threads. Thread safety: const members may be called from any thread, each with
/// its own scratch, inside a FlushDenormals scope.
class TileRaster {
 public:
  /// Keeps references to its arguments. `chunks`: the chunks of `accel`; all strands must be in fur trees.
  TileRaster(const FrameScene& scene, const Accel& accel, const ResidentChunks& chunks,
             const CameraSamples& camera)
      : scene_(scene),
        accel_(accel),
        chunks_(chunks),
        camera_(camera),
        min_width_{scene.camera.lod_view(), scene.render.min_width()} {}

  /// Memory and result of one thread.
  struct Scratch {
    struct Candidate {
      float entry = 0;
      uint32_t chunk = 0;
      bool operator<(const Candidate& o) const {
        return entry != o.entry ? entry < o.entry : chunk < o.chunk;
      }
    };

    std::vector<CameraSample> samples;  ///< by slot, as the following
    std::vector<TileLine> drawn;
    TileLines lines;
    TileHits hits;
    std::vector<Candidate> candidates[2];  ///< by ChunkKind
    uint32_t samples_per_pixel = 0;
    StrandCache held;
    int64_t traced = 0;   ///< samples whose ray was traced
    double growth_s = 0;  ///< CPU seconds of the last find() in which chunks were grown
  };
  /// Returns the max memory of a scratch for this count of samples, in bytes.
  static size_t scratch_bytes(size_t samples);

  /// Draws the tile for samples first .. first + count - 1 of each pixel. Returns false when `job` was
  /// cancelled. Call end() for the last tile before.
  bool find(const Tile& tile, uint32_t first, uint32_t count, const Job& job, int worker,
            Scratch& scratch) const;
  /// Returns camera sample first + `sample` of a pixel.
  static const CameraSample& sample(uint32_t pixel, uint32_t sample, const Scratch& scratch) {
    return scratch.samples[slot(pixel, sample, scratch)];
  }
  /// Returns what this sample sees. Like Accel::closest(), stores the geometry in `thread.hit_geometry`. Call
  /// end() before other code uses `thread.hit_geometry`.
  Hit closest(uint32_t pixel, uint32_t sample, TraceThread& thread, Scratch& scratch) const;
  static void end(TraceThread& thread, Scratch& scratch) {
    scratch.held.take_back(thread.hit_geometry.strand);
  }

 private:
  /// The frame and the start depths of the lines of a tile.
  struct View {
    TileFrame frame;
    Range starts;
    float reference = 0;   ///< see TileLines::assign()
    bool possible = true;  ///< false: the lines diverge too much to be drawn
  };
  View make_lines(const Tile& tile, uint32_t first, uint32_t count, Scratch& scratch) const;
  void sort_lines(const View& view, const Range& depths, Scratch& scratch) const;

  enum ChunkKind : size_t { kFur, kSkin };
  /// A chunk of each kind.
  using Candidates = std::array<Scratch::Candidate, 2>;
  void find_candidates(std::array<bool, 2> wanted, const Beam& beam, float far, const Candidates& after,
                       Scratch& scratch) const;
  static size_t slot(uint32_t pixel, uint32_t sample, const Scratch& scratch) {
    return size_t{pixel} * scratch.samples_per_pixel + sample;
  }
  bool draw_all(const View& view, const Range& all, const Job& job, int worker, Scratch& scratch) const;
  bool find_hits(const Job& job, int worker, Scratch& scratch) const;
  void grow(uint32_t chunk, int worker, Scratch& scratch) const;
  std::optional<Hit> drawn_hit(size_t slot, TraceThread& thread, Scratch& scratch) const;
  Box3f seen_box(const Box3f& box) const { return min_width_.pixels > 0 ? min_width_.around(box) : box; }
  bool may_be_seen(uint32_t chunk, const TileDrawing& drawing) const;
  bool segment_cell_bounds_may_be_seen(uint32_t chunk, const TileDrawing& drawing) const;

  const FrameScene scene_;
  const Accel& accel_;
  const ResidentChunks& chunks_;
  const CameraSamples& camera_;
  const MinWidth min_width_;
};

}  // namespace pelage
