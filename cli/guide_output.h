// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/options.h"
#include "cli/run.h"
#include "world/coat_motion.h"

namespace pelage {

/// Checks `--groom` and the files of `-o` of `pelage simulate` before long work. Throws Error: kArguments,
/// and kFailed if they cannot be written.
void check_guide_output(const Options& options, const SceneDescription& scene);

/// Returns the coat whose guides `-o` writes: the one of `--groom`, or the only one. `coats`: all coats with
/// `dynamics`. Throws Error (kArguments) if there are several or none.
const MovingCoat& coat_to_write(const Options& options, const std::vector<MovingCoat>& coats);

/// Writes the guides of a coat for each frame of the scene. Each file is written as a whole or not at all.
void write_guides(const Options& options, const SceneDescription& scene, const Assets& assets,
                  const MovingCoat& coat, Run& run);

}  // namespace pelage
