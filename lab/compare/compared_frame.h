// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/job.h"
#include "lab/report/report.h"
#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

/// What one model cost and gave in one light.
struct ComparedFrame {
  std::string model, light;
  double wall_s = 0, cpu_s = 0;
  double cpu_spread = 0;  ///< what its two halves differ by in CPU time, over the longer one
  double rays = 0;        ///< of all kinds
  double fur_share = 0;   ///< of the pixels
  double luminance = 0;   ///< mean over the pixels whose front-most surface is a strand
  double noise = 0;       ///< relMSE there, by the difference of two halves of the samples
  Picture picture;
};

/// Renders scenes of the same animals in different materials and lights. What grows them is read once.
class FrameComparer {
 public:
  FrameComparer(const SceneDescription& scene, Assets& assets, const Job& job);

  /// One frame with the materials given, in two halves of independent seeds. Throws Error.
  ComparedFrame render(const std::vector<MaterialParams>& materials, const Named<LightParams>& lights,
                       const std::string& model, const std::string& light);
  /// Everything white that is not black, in an even white light, on a picture of a quarter of the width: the
  /// mean radiance of fur, 1 where what a coat gives back is what it gets.
  double furnace(const std::vector<MaterialParams>& materials);

 private:
  SceneDescription scene_;
  Assets& assets_;
  Job job_;
};

}  // namespace pelage
