// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/ledger.h"
#include "base/stopwatch.h"
#include "render/frame/frame_statistics.h"
#include "render/frame/tile_integrator.h"
#include "render/gather/indirect_paths.h"
#include "render/gather/light_sharing.h"
#include "render/gather/path_sharing.h"
#include "render/gather/shadow_rays.h"
#include "render/gather/visible_points.h"
#include "render/light/far_light_samples.h"
#include "render/raster/tile_raster.h"
#include "render/reflection/cache_fill.h"

namespace pelage {

/// The integrator `gather`: finds the points that the camera samples of a tile see, and traces some of the
/// rays that leave these points. The light that these rays find is shared among all points of the same gather
/// point (a position on a strand or skin, see GatherPointKey). Samples of different tiles never share light.
/// The result depends only on the scene, the tile and the indices of its samples.
class GatherTracer final : public TileIntegrator {
 public:
  /// Memory of the tiles that are traced at the same time.
  struct Memory {
    int tiles = 0;  ///< max count of such tiles
    MemoryCharge charge;
    std::optional<CacheFill::Memory> cache;  ///< of the reflection cache
  };
  /// Reserves memory for one tile per thread. Call before chunks take the rest of the memory. If the tiles of
  /// all threads together would need more than an eighth of `render.memory`, reserves memory for fewer tiles,
  /// but for at least one. Threads then wait for each other. Throws Error (kMemory) when not even one tile
  /// fits.
  static Memory reserve(const FrameScene& scene, const Job& job);

  /// Keeps references to its arguments, except `options` and `memory`. `chunks`: the chunks of `accel`.
  GatherTracer(const FrameScene& scene, const Accel& accel, const ResidentChunks& chunks,
               const FilmLayers& layers, const PathOptions& options, Memory memory);
  /// Fills the reflection cache, if the scene uses it. Call before the first tile. `clock`: the time limit
  /// starts with it. Returns the costs of all threads, and adds the counts to `statistics`.
  TileCosts fill_cache(const Job& job, const Stopwatch& clock, FrameStatistics& statistics);

  std::unique_ptr<SampleScratch> make_scratch() const override;
  int max_tiles(int /*threads*/) const override { return memory_.tiles; }
  bool shares_light() const override { return true; }
  uint32_t together(uint32_t first, uint32_t end) const override;
  bool trace_tile(const TileTask& task, SampleScratch& scratch) const override;

  /// Returns the max count of samples per pixel that share light, for a scene with this count of lights. The
  /// max limits the memory of a scratch.
  static uint32_t max_samples(size_t lights);
  /// Returns the max memory of a scratch, in bytes, if up to `samples` samples per pixel share light.
  /// `draws`: RenderParams::draws_visible().
  static size_t scratch_bytes(size_t lights, uint32_t samples, bool draws);

 private:
  struct Scratch;
  bool gather(const Tile& tile, uint32_t first, uint32_t count, const Job& job, Scratch& scratch) const;
  bool look(uint32_t first, uint32_t count, const Job& job, Scratch& scratch) const;
  void add_unoccluded(Scratch& scratch) const;
  void add_scattered(uint32_t point, Scratch& scratch) const;
  void add_samples(const TileTask& task, Scratch& scratch) const;

  const FrameScene scene_;
  const Accel& accel_;
  const FilmLayers& layers_;
  const FarLightSamples far_lights_;
  const PathOptions options_;
  Memory memory_;
  const bool first_alone_;  // whether the first sample of a pixel shares no light with further samples
  FrameShading shading_;
  CameraSamples camera_;
  std::optional<TileRaster> raster_;
  VisiblePoints points_;
  ShadowRays shadow_rays_;
  std::optional<ReflectionCache> cache_;
  IndirectPaths indirect_paths_;
};

}  // namespace pelage
