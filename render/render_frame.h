// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/job.h"
#include "render/frame/frame_result.h"
#include "render/path/path_tracer.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// Renders one frame with the integrator of the scene (render.integrator). First bounds all chunks. Then
/// takes samples in passes over the whole picture (SampleSchedule, or GatherLoop for `gather`). A picture
/// that is cancelled at any time is therefore valid, but has fewer samples.
///
/// The same scene gives the same film for any number of threads, unless the time limit is reached. Throws
/// Error. An error in a render thread reaches the caller after all threads have stopped.
FrameResult render_frame(const RenderScene& scene, const Job& job, const PathOptions& options = {});

}  // namespace pelage
