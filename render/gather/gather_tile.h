// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/job.h"
#include "render/frame/gather_point_statistics.h"
#include "render/frame/tile_order.h"
#include "render/gather/indirect_paths.h"
#include "render/gather/light_sharing.h"
#include "render/gather/path_sharing.h"
#include "render/gather/shadow_rays.h"
#include "render/gather/visible_points.h"
#include "render/raster/tile_raster.h"

namespace pelage {

/// Renders a tile. Finds the points that its camera samples see, and traces some of the rays that leave these
/// points. All visible points that are assigned to the same gather point (see GatherPointKey) share the light
/// that these rays find. The result depends only on the scene, the tile and the indices of its samples.
///
/// Thread safety: const members may be called from any thread, each with its own scratch.
class GatherTile {
 public:
  /// Side of a tile in pixels. Samples of different tiles never share light.
  static constexpr int kSide = FilmSums::kTileSide;

  /// Keeps references to its arguments, except `options`. `chunks`: the chunks of `accel`.
  /// `cache`: see IndirectPaths.
  GatherTile(const RenderScene& scene, const Accel& accel, const ResidentChunks& chunks,
             const FilmLayers& layers, const PathOptions& options,
             const std::optional<ReflectionCache>& cache);

  struct Scratch;
  std::unique_ptr<Scratch> make_scratch() const;
  /// Returns the max count of samples per pixel in one call of trace(), for a scene with this count of
  /// lights. The max limits the memory of a scratch.
  static uint32_t max_samples(size_t lights);
  /// Returns the count of samples per pixel that one call of trace() takes at most when it renders a scene.
  static uint32_t samples_at_once(const RenderScene& scene);
  /// Returns the max memory of a scratch, in bytes, if trace() takes up to `samples` samples per pixel at
  /// once. `draws`: RenderParams::draws_visible().
  static size_t scratch_bytes(size_t lights, uint32_t samples, bool draws);

  /// Traces samples first .. first + count - 1 of each pixel. Stores the result in `scratch`. Returns false
  /// when `job` was cancelled.
  bool trace(const Tile& tile, uint32_t first, uint32_t count, const Job& job, Scratch& scratch) const;
  /// Adds the result of the last trace() to the film, which stores the pixels `window` of the picture.
  /// Returns the count of samples that were not added because they are not finite.
  int64_t add_to(const PixelBox& window, Film& film, Scratch& scratch) const;

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

/// Memory, results and counts of one thread.
struct GatherTile::Scratch final : SampleScratch {
  TileSamples samples;
  TileRaster::Scratch raster;
  VisiblePoints::Scratch look;
  ShadowRays::Scratch shadow_rays;
  IndirectPaths::Scratch indirect_paths;
  LightSharing lights;
  PathSharing paths;
  GatherPointStatistics gather_points;
  uint32_t first_sample = 0;  ///< index of the first sample of the current call of trace()
};

}  // namespace pelage
