// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/job.h"
#include "render/frame/tile_order.h"
#include "render/gather/light_sharing.h"
#include "render/gather/path_sharing.h"
#include "render/gather/visible_points.h"
#include "render/path/path_walk.h"

namespace pelage {

/// Renders a tile: finds what its camera samples see, traces a part of the rays that leave these points, and
/// divides the light that they find among the points of the same knot. A tile shares nothing with others, and
/// is a function of (scene, tile, range of samples) only.
///
/// Thread safety: const members from any thread, each with its own scratch.
class GatherTile {
 public:
  /// Pixels along the side of a tile, whose knots end at its border.
  static constexpr int kSide = FilmSums::kTileSide;

  /// References are kept.
  GatherTile(const RenderScene& scene, const Accel& accel, const FilmLayers& layers,
             const PathOptions& options);

  struct Scratch;
  std::unique_ptr<Scratch> make_scratch() const;
  /// Number of samples per pixel that trace() accepts at once: what limits the memory of a scratch.
  uint32_t max_samples() const { return max_samples(scene_.lights.size()); }
  static uint32_t max_samples(size_t lights);
  /// Max memory of a scratch for up to `samples` per pixel at once.
  static size_t scratch_bytes(size_t lights, uint32_t samples);

  /// Traces samples first .. first + count - 1 of each pixel. Returns false when `job` was cancelled.
  bool trace(const Tile& tile, uint32_t first, uint32_t count, const Job& job, Scratch& scratch) const;
  /// Adds the result of the last trace() to the film. Returns the number of samples that are not finite.
  int64_t add_to(Film& film, Scratch& scratch) const;

 private:
  class PathSink;
  bool look(uint32_t begin, uint32_t end, const Job& job, Scratch& scratch) const;
  bool trace_lights(size_t first, const Job& job, Scratch& scratch) const;
  bool trace_paths(const Job& job, Scratch& scratch) const;

  const RenderScene& scene_;
  const Accel& accel_;
  const FilmLayers& layers_;
  const PathOptions options_;
  FrameShading shading_;
  CameraSamples camera_;
  VisiblePoints points_;
  PathWalk<PathSink> walk_;
};

/// Memory and counts of one thread.
struct GatherTile::Scratch final : SampleScratch {
  Tile tile;
  uint32_t first = 0, count = 0;
  TileSamples samples;
  VisiblePoints::Scratch look;
  LightSharing lights;
  PathSharing paths;
  DirectLightScratch direct;
  std::vector<uint64_t> order;      // points by knot and light
  std::vector<double> masses;       // of light rays, in that order
  std::vector<double> pixel_light;  // mean unoccluded luminance of the points of each pixel
  std::vector<Rgb> arriving;        // by light: of one path
};

}  // namespace pelage
