// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/options.h"

namespace CLI {
class App;
}

namespace pelage {

/// Flags of `measure` that concern one experiment.
void add_experiment_flags(CLI::App& measure, Options& options);

/// Sets the experiment of this name, unless it is empty, and checks its flags. Throws Error (kArguments).
void interpret_experiment(const std::string& name, Options& options);

}  // namespace pelage
