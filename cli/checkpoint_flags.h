// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace pelage {

/// Flags of `render` that concern checkpoints.
struct CheckpointOptions {
  std::optional<std::string> folder;  ///< --checkpoint
  double every_s = 60;                ///< --every: seconds between two checkpoints
  bool resume = false;                ///< --resume: continue from the checkpoints in the folder
};

/// `every`: gets the text of --every.
void add_checkpoint_flags(CLI::App& render, CheckpointOptions& checkpoint, std::string& every);

/// Reads the text of --every: "60s", "5m", "2h" or a number of seconds. Throws Error (kArguments).
void interpret_checkpoint(const std::string& every, CheckpointOptions& checkpoint);

}  // namespace pelage
