// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "base/job.h"
#include "render/accel/fur_chunk_file.h"
#include "render/accel/resident_chunks.h"
#include "render/frame/frame_chunks.h"
#include "render/scene/render_params.h"

namespace pelage {

/// Opens the file that holds the fur chunks of a frame, in the folder `render.bvh.file`. If there is no such
/// file yet, grows all fur, builds its trees and writes the file first.
///
/// Returns null after one warning if the chunks cannot be stored: a leaf has no content hash
/// (Procedural::content()), a coat is not opaque everywhere, or the folder cannot be written. Also returns
/// null when cancelled. Errors of growing fur reach the caller.
std::shared_ptr<const FurChunkFile> stored_fur(const RenderParams& params, const FrameChunks& chunks,
                                               const ResidentChunksOptions& options, const Job& job);

}  // namespace pelage
