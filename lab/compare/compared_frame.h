// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/job.h"
#include "lab/report/report.h"
#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

/// Cost and result of one model in one light.
struct ComparedFrame {
  std::string model, light;
  double wall_s = 0, cpu_s = 0;
  double cpu_spread = 0;  ///< difference of the CPU times of the two halves / the longer time
  double rays = 0;        ///< number of rays of all kinds
  double fur_share = 0;   ///< fraction of the pixels that show fur
  double luminance = 0;   ///< mean over the pixels whose front-most surface is a strand
  double noise = 0;       ///< relMSE of these pixels, from the difference of two halves of the samples
  Picture picture;
};

/// Renders scenes with the same animals in different materials and lights. Reads the geometry once.
class FrameComparer {
 public:
  FrameComparer(const SceneDescription& scene, Assets& assets, const Job& job);

  /// One frame with the given materials, in two halves with independent seeds. Throws Error.
  ComparedFrame render(const std::vector<MaterialParams>& materials, const Named<LightParams>& lights,
                       const std::string& model, const std::string& light);
  /// Mean radiance of fur in a furnace test: everything that is not black becomes white, in a uniform white
  /// light, at a quarter of the picture's width. 1 where a coat conserves energy.
  double furnace(const std::vector<MaterialParams>& materials);

 private:
  SceneDescription scene_;
  Assets& assets_;
  Job job_;
};

}  // namespace pelage
