// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "farm/farm_plan.h"

namespace pelage {

/// The tasks of a shot, and where they run.
struct FarmPlan {
  std::filesystem::path folder;  ///< in which the commands run
  int threads = 0;               ///< value of --threads; 0: all of the machine
  std::vector<FarmTask> tasks;   ///< each after the tasks that it depends on
};

/// Returns a plan as JSON, see docs/FARM.md.
std::string plan_json(const FarmPlan& plan);

/// Reads the text of plan_json(). `path`: for messages. Throws Error (kInput) if the text is no such plan.
FarmPlan parse_plan(const std::string& text, const std::filesystem::path& path);

}  // namespace pelage
