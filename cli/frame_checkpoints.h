// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.h"
#include "cli/signals.h"
#include "world/checkpoint.h"

namespace pelage {

/// The checkpoints of the frames of a run of `render --checkpoint`. Without this flag, it does nothing.
class FrameCheckpoints {
 public:
  /// Checks that checkpoints can be written to the folder. `scene` must outlive the object. Throws Error:
  /// kArguments if the scene cannot have checkpoints, kInput if the folder cannot be read to resume, kFailed
  /// if it cannot be written.
  FrameCheckpoints(const Options& options, const SceneDescription& scene, Progress& progress);

  /// Returns the frames that are not finished. With --resume, reads the checkpoints of all frames, and says
  /// which frames are finished, which continue and which start from the beginning. `picture`: returns the
  /// output file of a frame. Throws Error (kInput) when a checkpoint belongs to another render.
  std::vector<int> unfinished(const std::vector<int>& frames,
                              const std::function<std::string(int frame)>& picture);

  /// Returns the checkpoint of one of these frames; null without --checkpoint.
  Checkpoint* of(int frame);

 private:
  CheckpointOptions options_;
  std::optional<PixelBox> region_;
  const SceneDescription& scene_;
  Progress& progress_;
  std::optional<CheckpointSignal> signal_;
  FrameInputs inputs_;
  std::map<int, std::unique_ptr<Checkpoint>> checkpoints_;  // by frame
};

}  // namespace pelage
