// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "cli/run.h"
#include "post/band_job.h"

namespace pelage {

/// Runs a tool for every frame of `--frames`, with the frame number inserted in the names of input and
/// output; without `--frames`, runs it once with the names as given. Reports what was written. Returns the
/// exit code. Throws Error (kArguments) when names and frames are inconsistent or the output is not an .exr.
/// Passes on exceptions of `work`.
using PostWork = std::function<PostReport(const std::string& input, const std::string& output, Run& run)>;
int run_post_frames(const Options& options, const PostWork& work);

}  // namespace pelage
