// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/options.h"

namespace pelage {

// One function per command, in a file of its own. Each returns the exit code of the process and throws Error
// for what users and the outside world do wrong.

int run_render(const Options& options);
int run_grow(const Options& options);
int run_measure(const Options& options);
int run_trace(const Options& options);
int run_compare(const Options& options);
int run_info(const Options& options);
int run_convert(const Options& options);
int run_motion_blur(const Options& options);
int run_stereo(const Options& options);
int run_manual(const Options& options);

}  // namespace pelage
