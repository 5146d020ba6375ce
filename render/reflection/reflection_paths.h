// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "base/job.h"
#include "render/frame/tile_order.h"
#include "render/path/path_walk.h"
#include "render/reflection/cell_keys.h"
#include "render/reflection/reflection_table.h"

namespace pelage {

/// Traces the paths that fill the reflection cache. A path starts at a camera sample of its own and is traced
/// as `path` does, to its end. It gives one estimate of the radiance that leaves its third surface towards
/// the second one, by light, to each cell that contains this surface; without the light that shadow rays from
/// this surface find, because each path that ends in a cell traces such rays itself. So a path traces no
/// shadow rays before its fourth surface. At its third surface, it divides into kBranches branches: finding
/// this surface costs about as much as the rest of a branch, which brings most of the noise. The estimates
/// are unbiased, so the mean of a cell keeps energy. Thread safety: const members may be called from any
/// thread, each with its own scratch.
class ReflectionPaths {
 public:
  /// Keeps references to its arguments, except `options`.
  ReflectionPaths(const FrameScene& scene, const Accel& accel, const FrameShading& shading,
                  const CameraSamples& camera, const PathOptions& options);

  struct Scratch final : SampleScratch {
    DirectLightScratch direct;
    std::vector<Rgb> reflected;  // by the third surface of a path, by light
  };

  /// The part of all paths that is traced at once.
  struct Share {
    uint32_t round = 0;  ///< number of the part
    double paths = 0;    ///< mean count per pixel
    CellRange cells;     ///< only paths to these cells are traced to their ends
  };

  /// Traces a share of the paths of the pixels of a tile, and adds the paths that reach cells of the share to
  /// `table`. Returns false when `job` was cancelled.
  bool trace(const Tile& tile, const Share& share, const Job& job, Scratch& scratch,
             ReflectionTable& table) const;

 private:
  /// More branches give better estimates, but cost more than they gain (docs/lab/GATHER.md).
  static constexpr uint32_t kBranches = 2;

  class Recorder;
  void follow(int x, int y, uint32_t sample, const CellRange& cells, Scratch& scratch,
              ReflectionTable& table) const;

  const FrameScene scene_;
  const Accel& accel_;
  const FrameShading& shading_;
  const CameraSamples& camera_;
  const PathOptions options_;
  const CellKeys keys_;
  PathWalk<Recorder> walk_;
};

}  // namespace pelage
