// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/options.h"

namespace pelage {

// One function per command, each in its own source file. Each function returns the exit code of the process.
// It throws Error for mistakes of the user and failures of the system.

int run_new(const Options& options);
int run_render(const Options& options);
int run_grow(const Options& options);
int run_simulate(const Options& options);
int run_info(const Options& options);
int run_merge(const Options& options);
int run_farm(const Options& options);
int run_convert(const Options& options);
int run_motion_blur(const Options& options);
int run_stereo(const Options& options);
int run_rib(const Options& options);
int run_validate(const Options& options);
int run_export(const Options& options);
int run_procedural(const Options& options);
int run_view(const Options& options);
int run_why(const Options& options);
int run_manual(const Options& options);

}  // namespace pelage
