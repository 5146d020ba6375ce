// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "post/band_job.h"

namespace pelage {

struct BlurFileParams {
  PostFileParams file;
  ShutterParams shutter;
  PostTiling tiling;
};

/// Processes one file as `pelage motionblur` does: blurs each view that has motion vectors, and copies the
/// other views. Parts keep their names, channels, types and attributes. Their data windows grow by the
/// motion, up to the display window. Throws Error (kInput) when no view has motion vectors, or when a view
/// with motion vectors has no depth. Passes on the errors of BandJob.
PostReport blur_file(const std::filesystem::path& input, const std::filesystem::path& output,
                     const BlurFileParams& params, const Job& job);

}  // namespace pelage
