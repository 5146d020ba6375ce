// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/job.h"
#include "render/frame/frame_result.h"
#include "world/assets.h"
#include "world/compose.h"
#include "world/scene_schema.h"

// Pelage as a library: from a scene file to a picture in five calls.
//
//   load_scene     reads the scene file                                       world/scene_schema.h
//   load_assets    reads the files it names, places follicles,
//                  prepares grooms                                            world/assets.h
//   compose        poses everything for one frame                             world/compose.h
//   render         grows and traces; the result is a film
//   write_frame    writes it as an EXR file
//
// A Job (base/job.h) holds the threads, the memory ledger, and the Progress that reports how far the work is
// and can request a stop. One scene and its assets serve any number of frames. All five throw Error
// (base/error.h): kInput for mistakes in files, with file, line and column; kMemory if memory does not
// suffice under `render.memory`; kStopped once Progress::cancelled() returned true. Exception: when
// cancelled, render() returns a partial picture instead.

namespace pelage {

/// Renders a composed frame with the integrator of the scene, see render_frame().
FrameResult render(const World& world, const Job& job);

/// Writes a rendered frame as EXR, completely or not at all. `seconds`: duration of the render, stored in the
/// header of the file. Throws Error (kFailed).
void write_frame(const std::filesystem::path& path, const World& world, const FrameResult& result,
                 double seconds, const Job& job);

/// Sets the limit of the ledger to `render.memory` and reserves memory for the film of a frame, so that
/// load_assets() fails early when there would be no room for it. Release the charge before render(), which
/// charges the film again.
MemoryCharge reserve_film(const SceneDescription& scene, const Job& job);

}  // namespace pelage
