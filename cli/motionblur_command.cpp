// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"
#include "cli/post_frames.h"
#include "post/blur_file.h"

namespace pelage {

int run_motion_blur(const Options& options) {
  return run_post_frames(options, [&](const std::string& input, const std::string& output, Run& run) {
    return blur_file(input, output, options.motion_blur, run.job());
  });
}

}  // namespace pelage
