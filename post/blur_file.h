// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "post/band_job.h"

namespace pelage {

struct BlurFileParams {
  PostFileParams file;
  ShutterParams shutter;
  PostTiling tiling;
};

/// `pelage motionblur` on one file: blurs each view that has motion vectors and copies the other views. Parts
/// keep their names, channels, types and attributes; their data windows grow by the motion, up to the display
/// window. Throws Error (kInput) when no view has vectors or a view with vectors has no depth; throws the
/// errors of BandJob.
PostReport blur_file(const std::filesystem::path& input, const std::filesystem::path& output,
                     const BlurFileParams& params, const Job& job);

}  // namespace pelage
