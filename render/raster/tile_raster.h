// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/job.h"
#include "render/accel/accel.h"
#include "render/accel/resident_chunks.h"
#include "render/frame/camera_samples.h"
#include "render/frame/tile_order.h"
#include "render/raster/held_strands.h"
#include "render/raster/tile_frame.h"
#include "render/raster/tile_lines.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// Finds what the camera samples of a tile see, by drawing strands and skins instead of tracing a ray per
/// sample. Drawing decides which primitive a sample sees; closest() then intersects the sample's ray with
/// this primitive alone. Where they disagree the ray is traced, so that a hit is always one of the ray, and
/// nearly always the nearest.
///
/// The result depends on the scene, the tile and the numbers of its samples only: not on chunks, on which of
/// them are resident, or on threads. Thread safety: const members from any thread, each with its own scratch,
/// inside a FlushDenormals scope.
class TileRaster {
 public:
  /// References are kept. `chunks`: those of `accel`, with strands in fur trees only.
  TileRaster(const RenderScene& scene, const Accel& accel, const ResidentChunks& chunks,
             const CameraSamples& camera)
      : scene_(scene), accel_(accel), chunks_(chunks), camera_(camera) {}

  /// Memory and the result of one thread.
  struct Scratch {
    struct Candidate {
      float entry = 0;
      uint32_t chunk = 0;
      bool operator<(const Candidate& o) const {
        return entry != o.entry ? entry < o.entry : chunk < o.chunk;
      }
    };

    std::vector<TileLine> drawn;
    TileLines lines;
    std::vector<Candidate> candidates;
    uint32_t samples_per_pixel = 0;
    HeldStrands held;
    int64_t traced = 0;  ///< samples whose ray was traced
  };
  /// Max memory of a scratch.
  static size_t scratch_bytes(size_t samples);

  /// Draws what samples first .. first + count - 1 of all pixels of a tile see. Returns false when `job` was
  /// cancelled.
  bool find(const Tile& tile, uint32_t first, uint32_t count, const Job& job, int worker,
            Scratch& scratch) const;
  /// What sample first + `sample` of a pixel sees; `ray`: its camera ray. As Accel::closest(): stores the
  /// geometry in `thread.met`. Call end() before something else uses that.
  Hit closest(uint32_t pixel, uint32_t sample, const Ray& ray, TraceThread& thread, Scratch& scratch) const;
  static void end(TraceThread& thread, Scratch& scratch) { scratch.held.take_back(thread.met.strand); }

 private:
  bool place_lines(const Tile& tile, uint32_t first, uint32_t count, TileFrame& frame, Range& starts,
                   Scratch& scratch) const;

  void find_candidates(bool skins, const Beam& beam, float far, const Scratch::Candidate& after,
                       Scratch& scratch) const;
  bool may_be_seen(uint32_t chunk, const Beam& beam, float far) const;

  const RenderScene& scene_;
  const Accel& accel_;
  const ResidentChunks& chunks_;
  const CameraSamples& camera_;
};

}  // namespace pelage
