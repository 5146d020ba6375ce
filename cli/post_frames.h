// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "cli/options.h"
#include "cli/run.h"
#include "post/band_job.h"

namespace pelage {

/// Processes one picture: reads the file `input` and writes the file `output`.
using PostWork = std::function<PostReport(const std::string& input, const std::string& output, Run& run)>;
/// Calls `work` for every frame of `--frames`, with the frame number inserted in the names of input and
/// output. Without `--frames`, calls `work` once, with the names as they were given. Prints a line about each
/// file that was written. Returns the exit code of the process. Throws Error (kArguments) when the names do
/// not fit the frames or the output is not an .exr file. Passes on exceptions of `work`.
int run_post_frames(const Options& options, const PostWork& work);

}  // namespace pelage
