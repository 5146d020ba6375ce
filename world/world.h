// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "base/job.h"
#include "render/frame/frame_result.h"
#include "render/frame_options.h"
#include "world/assets.h"
#include "world/compose.h"
#include "world/scene_schema.h"

// Pelage as a library: from a scene file to a picture in five calls.
//
//   load_scene     reads the scene file                                       world/scene_schema.h
//   load_assets    reads the files of the scene, places follicles,
//                  prepares grooms                                            world/assets.h
//   compose        poses everything for one frame                             world/compose.h
//   render         grows and traces; the result is a film
//   write_frame    writes the film as an EXR file
//
// A Job (base/job.h) refers to the threads, the memory ledger, and a Progress. The Progress receives reports
// on the work, and its member cancelled() can stop the work. One scene and its assets can be used for any
// number of frames.
//
// All five functions throw Error (base/error.h): kInput for mistakes in files, with file, line and column;
// kMemory if `render.memory` does not suffice; kStopped once Progress::cancelled() has returned true. Only
// render() is different when it is cancelled: it returns a partial picture.

namespace pelage {

/// Renders a composed frame with the integrator that the scene selects. See render_frame().
FrameResult render(const World& world, const Job& job, const FrameOptions& options = {});

/// Returns the header of a rendered frame. `seconds`: duration of the render.
FrameHeader finished_header(const World& world, const FrameResult& result, double seconds);

/// Writes a rendered frame, completely or not at all. As an EXR file, the display window is the whole
/// picture, and the data window is the region that was rendered. If the extension of the path is .png, .jpg
/// or .jpeg, writes only the radiance of the region, through view_transform(). `seconds`: duration of the
/// render, for the header of the file. Throws Error (kFailed) when the file cannot be written.
void write_frame(const std::filesystem::path& path, const World& world, const FrameResult& result,
                 double seconds, const Job& job);

/// Does the same when the world may have changed since the render. `header`: from finished_header().
void write_frame(const std::filesystem::path& path, const FrameHeader& header, const Camera& camera,
                 const FrameResult& result, const Job& job);

/// Sets the limit of the ledger to `render.memory` and charges the memory of a frame's film. Throws Error
/// (kMemory) when the film does not fit. While the caller keeps this charge, load_assets() fails early if the
/// memory limit has no room for both its data and the film. Release the charge before render(), because
/// render() charges the film itself. `region`: see FrameOptions.
MemoryCharge reserve_film(const SceneDescription& scene, const Job& job,
                          const std::optional<PixelBox>& region = {});

}  // namespace pelage
