// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "world/coat_motion.h"

namespace pelage {

/// What a run of simulate() did.
struct SimulationReport {
  int simulated = 0;      ///< number of frames that were computed
  int found = 0;          ///< number of wanted frames that were stored before
  int rigid_frames = 0;   ///< number of frames in which guides followed their skin rigidly
  size_t most_rigid = 0;  ///< max number of such guides in a frame
  int begun = 0;          ///< frame from which the simulation was continued, or its first frame
  double seconds = 0;     ///< time of the simulation, without reading the scene
};

/// Simulates a coat and stores its motion for the frames first .. last. Continues from the latest
/// stored frame before the first missing one, and computes all frames up to the last missing one. So the
/// frames are the same however their range is divided over runs (law 1). Calls `done(frame)` after each
/// computed frame. Throws Error: kArguments if a frame is too far from the begin, kFailed if the motion
/// cannot be written, kStopped when the job is stopped.
SimulationReport simulate(const SceneDescription& scene, const Assets& assets, const MovingCoat& coat,
                          int first, int last, const Job& job, const std::function<void(int)>& done);

}  // namespace pelage
