// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "base/job.h"
#include "render/frame/frame_result.h"
#include "render/frame_options.h"
#include "render/scene/render_scene.h"

namespace pelage {

class FrameGeometry;
class KeptFur;

/// Throws Error (kArguments) when a region is empty or not within the picture. Also throws it with adaptive
/// sampling, where the sample count of a pixel depends on the whole picture.
void check_region(const ImageParams& image, const RenderParams& render, const PixelBox& region);

/// Throws Error (kArguments) when the frame cannot be continued bit for bit from a stored state: with
/// adaptive sampling or a time limit. See FrameSaver.
void check_saving(const RenderParams& render);

/// Returns the settings of the coarse pictures by `path` that a watch sees before a frame by `gather`.
FrameSettings coarse_settings(const FrameScene& scene);

/// Renders one frame with the integrator of the scene (render.integrator) or of `options.settings`. First
/// bounds all chunks. Then takes samples in passes over the whole picture (SamplePasses). A picture that is
/// cancelled at any time is therefore valid, but has fewer samples.
///
/// The same scene gives the same film for any number of threads, unless the time limit is reached. Throws
/// Error. An error in a render thread reaches the caller after all threads have stopped.
FrameResult render_frame(const RenderScene& scene, const Job& job, const FrameOptions& options = {});

/// Does the same with geometry that is kept from an earlier call. If `geometry` is null, makes the geometry
/// and stores it there, unless the job is cancelled. Otherwise, `geometry` must come from the same
/// RenderScene object. Since that call, only the lights, the pixels of the picture (`image`, except its size)
/// and the members of `render` that concern sampling may have changed, and the materials, except for the
/// opacity of fibres. The statistics of growth and residency count from when the geometry was made.
///
/// `kept`, if not null: chunks of the geometry of an earlier scene. See FrameGeometry::make().
FrameResult render_frame(const RenderScene& scene, const Job& job, const FrameOptions& options,
                         std::unique_ptr<FrameGeometry>& geometry, KeptFur* kept = nullptr);

}  // namespace pelage
