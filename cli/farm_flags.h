// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace pelage {

/// Flags of `farm`.
struct FarmOptions {
  int columns = 1, rows = 1;    ///< --regions
  std::string folder = "farm";  ///< --dir: checkpoints, pieces, statistics
  double every_s = 60;          ///< --every: seconds between two checkpoints
  bool json = false;            ///< --json: print JSON instead of shell commands
};

/// Values of these arguments that are still text.
struct FarmTexts {
  std::string action, regions, every;
};

void add_farm_flags(CLI::App& farm, FarmOptions& options, FarmTexts& texts);

/// Reads the texts. Throws Error (kArguments).
void interpret_farm(const FarmTexts& texts, FarmOptions& options);

}  // namespace pelage
