// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "base/job.h"
#include "render/accel/fur_chunk_file.h"
#include "render/accel/resident_chunks.h"
#include "render/frame/frame_chunks.h"
#include "render/scene/render_params.h"

namespace pelage {

/// The chunks of fur that `render.bvh.file` stores for a frame: opened, or grown, built and written first.
/// Returns null after one warning if they cannot be stored: the content of the fur has no hash, a coat is not
/// opaque everywhere, or the folder cannot be written. Also returns null when cancelled. Passes on errors of
/// growth.
std::shared_ptr<const FurChunkFile> stored_fur(const RenderParams& params, const FrameChunks& chunks,
                                               const ResidentChunksOptions& options, const Job& job);

}  // namespace pelage
