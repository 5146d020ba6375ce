// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "base/job.h"
#include "render/accel/fur_chunk_file.h"
#include "render/accel/resident_chunks.h"
#include "render/frame/frame_chunks.h"
#include "render/scene/render_params.h"

namespace pelage {

/// The chunks of fur that `render.bvh.file` keeps of a frame: opened, or grown, built and written first.
/// Null, after one warning, where they cannot be kept: of fur whose content has no name, of coats that are
/// not opaque everywhere, and where the folder cannot be written. Null, too, when cancelled. Throws what
/// growing throws.
std::shared_ptr<const FurChunkFile> stored_fur(const RenderParams& params, const FrameChunks& chunks,
                                               const ResidentChunksOptions& options, const Job& job);

}  // namespace pelage
