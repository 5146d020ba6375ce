// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/job.h"
#include "render/frame/tile_order.h"
#include "render/gather/indirect_paths.h"
#include "render/gather/light_sharing.h"
#include "render/gather/path_sharing.h"
#include "render/gather/shadow_rays.h"
#include "render/gather/visible_points.h"
#include "render/raster/tile_raster.h"

namespace pelage {

/// Renders a tile: finds what its camera samples see, traces some of the rays that leave these points, and
/// divides the light that they find among the points of the same knot. The result depends only on the scene,
/// the tile and the numbers of its samples.
///
/// Thread safety: const members from any thread, each with its own scratch.
class GatherTile {
 public:
  /// Side of a tile in pixels. Samples of different tiles share no knot.
  static constexpr int kSide = FilmSums::kTileSide;

  /// References are kept.
  GatherTile(const RenderScene& scene, const Accel& accel, const ResidentChunks& chunks,
             const FilmLayers& layers, const PathOptions& options);

  struct Scratch;
  std::unique_ptr<Scratch> make_scratch() const;
  /// Max number of samples per pixel of one call of trace(), which limits the memory of a scratch.
  static uint32_t max_samples(size_t lights);
  /// Max memory of a scratch for up to `samples` per pixel at once.
  static size_t scratch_bytes(size_t lights, uint32_t samples, const GatherParams& gather);

  /// Traces samples first .. first + count - 1 of each pixel. Returns false when `job` was cancelled.
  bool trace(const Tile& tile, uint32_t first, uint32_t count, const Job& job, Scratch& scratch) const;
  /// Adds the result of the last trace() to the film. Returns the number of samples that are not finite.
  int64_t add_to(Film& film, Scratch& scratch) const;

 private:
  bool look(uint32_t first, uint32_t count, const Job& job, Scratch& scratch) const;
  void add_scattered(uint32_t point, Scratch& scratch) const;

  const RenderScene& scene_;
  const Accel& accel_;
  const FilmLayers& layers_;
  FrameShading shading_;
  CameraSamples camera_;
  std::optional<TileRaster> raster_;
  VisiblePoints points_;
  ShadowRays shadow_rays_;
  IndirectPaths indirect_paths_;
};

/// Memory and counts of one thread.
struct GatherTile::Scratch final : SampleScratch {
  TileSamples samples;
  TileRaster::Scratch raster;
  VisiblePoints::Scratch look;
  ShadowRays::Scratch shadow_rays;
  IndirectPaths::Scratch indirect_paths;
  LightSharing lights;
  PathSharing paths;
  uint32_t first_sample = 0;  ///< of the current call of trace()
};

}  // namespace pelage
