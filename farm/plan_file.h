// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "farm/farm_plan.h"
#include "world/checkpoint_file.h"

namespace pelage {

/// Exit codes after which a task is run again: the machine failed, or the task was stopped or killed.
inline constexpr std::array kRetriedCodes{1, 129, 137, 143};

/// What the tasks of a shot will take.
struct ShotEstimate {
  uint64_t render_bytes = 0;  ///< memory to reserve for a task that reads the scene; 0: unknown
  uint64_t merge_bytes = uint64_t{512} << 20;  ///< memory to reserve for a merge
  double cpu_s = 0;                            ///< CPU seconds of all tasks, roughly
};

/// The tasks of a shot, and where they run.
struct FarmPlan {
  std::filesystem::path folder;  ///< in which the commands run
  int threads = 0;               ///< value of --threads; 0: all of the machine
  std::vector<FarmTask> tasks;   ///< each after the tasks that it depends on
  std::string shot = {};         ///< FarmRequest::folder: checkpoints, pieces, statistics, logs
  int retries = 9;               ///< how often a task with one of kRetriedCodes is run again
  ShotEstimate estimate = {};
  FrameInputs inputs = {};  ///< what determines the pixels of all frames, see frame_inputs(); empty: unknown
};

/// Returns one line that names what makes the pictures of two plans differ: "frames (1-12 before, 1-2 now),
/// `render.samples` ...". Empty if a plan continues what the other one has begun. Ignores the CPU
/// instructions of the machines that made the plans, and inputs if one plan has none.
std::string plan_differences(const FarmPlan& before, const FarmPlan& now);

/// Returns a plan as JSON, see docs/FARM.md.
std::string plan_json(const FarmPlan& plan);

/// Reads the text of plan_json(). `path`: for messages. Throws Error (kInput) if the text is no such plan.
FarmPlan parse_plan(const std::string& text, const std::filesystem::path& path);

/// Reads the plan in the folder of a shot. Throws Error (kInput) if the folder has no plan, or a damaged one.
FarmPlan read_plan(const std::filesystem::path& folder);

}  // namespace pelage
