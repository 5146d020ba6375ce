// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/job.h"
#include "render/frame/frame_result.h"
#include "render/path/path_tracer.h"
#include "render/scene/render_scene.h"

namespace pelage {

/// Renders one frame with the integrator of the scene (render.integrator). Bounds all chunks, then takes
/// samples in passes over the whole image (SampleSchedule). A picture cancelled at any time is therefore
/// valid; it has fewer samples.
///
/// The same scene gives the same film for any number of threads, unless the time limit is reached. Throws
/// Error; exceptions never leave the render loops directly.
FrameResult render_frame(const RenderScene& scene, const Job& job, const PathOptions& options = {});

}  // namespace pelage
