// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/options.h"

namespace CLI {
class App;
}

namespace pelage {

/// Adds the flags of `measure` that concern a single experiment.
void add_experiment_flags(CLI::App& measure, Options& options);

/// Sets the experiment named `name`; an empty name keeps the default experiment. Checks the flags of the
/// experiment, and sorts sample counts. Throws Error (kArguments).
void interpret_experiment(const std::string& name, Options& options);

}  // namespace pelage
