// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/job.h"
#include "lab/report/report.h"
#include "world/assets.h"
#include "world/scene_schema.h"

namespace pelage {

/// Cost and result of rendering with one model in one light.
struct ComparedFrame {
  std::string model, light;
  double wall_s = 0, cpu_s = 0;
  /// Difference between the CPU times of the two halves of the samples, divided by the longer of these times.
  double cpu_spread = 0;
  double rays = 0;       ///< number of rays, of all kinds together
  double fur_share = 0;  ///< fraction of the pixels that show fur
  double luminance = 0;  ///< mean luminance of the pixels whose front-most surface is a strand
  /// The relMSE of these pixels, estimated from the difference between two halves of the samples.
  double noise = 0;
  Picture picture;
};

/// Renders the animals of a scene in different materials and lights. Reads their geometry only once.
class FrameComparer {
 public:
  FrameComparer(const SceneDescription& scene, Assets& assets, const Job& job);

  /// Renders one frame with the given materials and lights, in two halves with independent seeds. `model` and
  /// `light` are names for the result. Throws Error.
  ComparedFrame render(const std::vector<MaterialParams>& materials, const Named<LightParams>& lights,
                       const std::string& model, const std::string& light);
  /// Returns the mean radiance of fur in a furnace test: a uniform white light, with materials that absorb
  /// nothing, at a quarter of the picture's width. The result is 1 if the coat conserves energy.
  double furnace(const std::vector<MaterialParams>& materials);

 private:
  SceneDescription scene_;
  Assets& assets_;
  Job job_;
};

}  // namespace pelage
