// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/options.h"

namespace pelage {

// The actions of `farm` that need Slurm. Each returns the exit code of the command, and throws Error for
// mistakes of the user and failures of the system. Only `status` works without Slurm.

/// Estimates the shot, writes its plan and scripts to its folder, and submits them.
int submit_shot(const Options& options);
/// Prints the state of a shot, and writes its page.
int show_shot(const Options& options);
/// Cancels the jobs of a shot that have not ended.
int cancel_shot(const Options& options);

}  // namespace pelage
