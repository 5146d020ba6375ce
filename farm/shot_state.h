// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <unistd.h>

#include "farm/plan_file.h"

namespace pelage {

enum class TaskStage {
  kWaiting,
  kRunning,
  kQueuedAgain,  ///< was stopped or killed, and will continue
  kDone,
  kCancelled,
  kFailed,
  kLost,  ///< began and did not end, and the queue does not know it: its machine failed
};
std::string_view stage_name(TaskStage stage);

/// What is known about a task.
struct TaskState {
  TaskStage stage = TaskStage::kWaiting;
  /// How often its command was started. A start of a task that was finished counts only if it fails.
  int starts = 0;
  int64_t began = 0;       ///< first start, in seconds since 1970; 0: never
  int64_t ended = 0;       ///< last end; 0: none
  double busy_s = 0;       ///< sum over all starts
  int exit_code = 0;       ///< of the last end
  std::string host;        ///< of the last start
  std::string log;         ///< path inside the folder of the shot
  double cpu_s = 0;        ///< of the last start, from the statistics of the run; 0: unknown
  int64_t peak_bytes = 0;  ///< largest resident set of the last start; 0: unknown
};

/// The state of all tasks of a shot, read from its folder.
struct ShotState {
  FarmPlan plan;
  std::vector<TaskState> tasks;  ///< by task of the plan
  uid_t owner = ::geteuid();     ///< of the plan

  int64_t count(TaskStage stage) const;
};

/// Elements of arrays that a queue still has: (number of the job, element).
using QueuedElements = std::map<std::pair<int64_t, int64_t>, std::string>;

/// Reads the output of `squeue -h -r -o "%F %K %T"`. Skips lines that are not of this form.
QueuedElements parse_queue(std::string_view text);

/// Applies the events that `task.sh` has noted, in order: lines of time, name and details. Skips lines that
/// it does not understand, because a machine may have failed while it wrote one. `now`: the time until which
/// a running task counts as busy.
TaskState read_events(std::string_view text, int64_t now);

/// Reads the state of a shot from its folder, without asking a queue. Follows no symbolic link there.
/// `queue`: what the queue knows; empty if it was not asked. Then a task whose machine failed counts as
/// running. Throws Error (kInput) if the folder has no plan, or a damaged one.
ShotState read_shot_state(const std::filesystem::path& folder, const std::optional<QueuedElements>& queue,
                          int64_t now);

/// Returns the numbers of all jobs that were submitted for the shot.
std::vector<int64_t> read_job_numbers(const std::filesystem::path& folder);

}  // namespace pelage
