// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"
#include "cli/post_frames.h"
#include "post/stereo_file.h"

namespace pelage {

int run_stereo(const Options& options) {
  return run_post_frames(options, [&](const std::string& input, const std::string& output, Run& run) {
    return stereo_file(input, output, options.stereo, run.job());
  });
}

}  // namespace pelage
