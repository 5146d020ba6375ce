// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "base/job.h"
#include "render/frame/frame_result.h"
#include "world/assets.h"
#include "world/compose.h"
#include "world/scene_schema.h"

// The face of Pelage as a library: from a scene file to a picture, in five calls.
//
//   load_scene     reads the scene file                                       world/scene_schema.h
//   load_assets    reads what it names, places follicles, prepares grooms     world/assets.h
//   compose        poses everything for one frame                             world/compose.h
//   render         grows and traces; the result is a film
//   write_frame    writes it as an EXR file
//
// A Job (base/job.h) carries the threads, the accounts of memory, and the Progress that shows how far the
// work is and says when to stop. Scene and assets serve any number of frames. All throw Error (base/error.h):
// kInput for mistakes in files, with file, line and column; kMemory for what `render.memory` has no room for;
// kStopped once Progress::cancelled() said so; render() returns a partial picture then.

namespace pelage {

/// Renders a composed frame with the integrator of the scene: see render_frame().
FrameResult render(const World& world, const Job& job);

/// Writes a rendered frame as EXR, whole or not at all. `seconds`: what making it took, for the header.
/// Throws Error (kFailed).
void write_frame(const std::filesystem::path& path, const World& world, const FrameResult& result,
                 double seconds, const Job& job);

/// Sets the limit of the ledger to `render.memory` and reserves the film of a frame, so that load_assets()
/// refuses what would leave no room for it. Give it back before render(), which makes its own.
MemoryCharge reserve_film(const SceneDescription& scene, const Job& job);

}  // namespace pelage
