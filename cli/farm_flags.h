// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace pelage {

enum class FarmAction { kPlan, kSubmit, kStatus, kCancel };

/// Flags of `farm`.
struct FarmOptions {
  FarmAction action = FarmAction::kPlan;
  int columns = 1, rows = 1;    ///< --regions
  std::string folder = "farm";  ///< --dir: checkpoints, pieces, statistics
  double every_s = 60;          ///< --every: seconds between two checkpoints
  bool json = false;            ///< --json: print JSON instead of shell commands or text

  std::string partition;            ///< submit: --partition
  std::string time;                 ///< submit: --time, in the form that Slurm reads
  std::vector<std::string> sbatch;  ///< submit: further options of sbatch
  int retries = 9;                  ///< submit: how often a stopped or killed task starts again
  bool dry_run = false;             ///< submit: print the scripts
};

/// Values of these arguments that are still text.
struct FarmTexts {
  std::string action, regions, every;
};

void add_farm_flags(CLI::App& farm, FarmOptions& options, FarmTexts& texts);

/// Reads the texts. `output`: value of -o. Throws Error (kArguments).
void interpret_farm(const FarmTexts& texts, const std::string& output, FarmOptions& options);

}  // namespace pelage
