// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "base/job.h"
#include "image/exr.h"
#include "render/frame_estimate.h"
#include "world/scene_schema.h"

namespace pelage {

/// What a run of `render` with some frames will take.
struct RunEstimate {
  std::vector<int> frames;
  std::vector<FrameEstimate> estimates;  ///< by frame
  double loading_cpu_s = 0;              ///< reading the scene and its files, measured
  double posing_cpu_s = 0;               ///< posing and dividing all frames, measured

  int64_t peak_bytes() const;  ///< max over all frames
  double cpu_s() const;        ///< of one run that renders all frames
  /// Returns the CPU time of a run that renders only the frame `i`.
  double cpu_s(size_t i) const;
};

/// Reads the files of the scene, poses each frame and estimates it. Throws the errors that these frames would
/// have before their first ray.
RunEstimate estimate_run(const SceneDescription& scene, const std::vector<int>& frames,
                         const std::optional<PixelBox>& region, const Job& job);

}  // namespace pelage
