// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "farm/plan_file.h"

namespace pelage {

/// How Slurm shall run the tasks of a shot.
struct SlurmParams {
  std::string folder;  ///< of the shot: scripts, logs, state; an absolute path
  /// Seconds before the time limit at which Slurm signals a task to write its checkpoint.
  int warning_s = 60;
  std::vector<std::string> options;  ///< for each call of sbatch: --partition=P, --time=60 ...
};

/// An array job: tasks that may run at the same time and depend on the same tasks.
struct SlurmJob {
  std::string name;           ///< "grow", "render-0001", "merge-0001", "render-1"
  std::vector<size_t> tasks;  ///< indices in FarmPlan::tasks; the first is element 1 of the array
  std::vector<size_t> after;  ///< indices of the jobs that must be finished before
};

/// Max number of elements of an array: the default of Slurm (MaxArraySize) allows indices up to 1000.
inline constexpr size_t kMaxArray = 1000;

/// Groups the tasks of a plan: all regions of a frame are one job, its merge another. Frames that are not
/// divided share jobs.
std::vector<SlurmJob> slurm_jobs(const FarmPlan& plan);

/// Returns the name of the log of a task, inside the folder of the shot.
std::string log_name(const SlurmJob& job, size_t element);

/// Returns the list of an array job: a line for each element, with the name of the task and its command.
std::string task_list(const FarmPlan& plan, const SlurmJob& job);

/// Returns the script that each element of an array runs: it notes its job, unless submit_script() has noted
/// it, starts the command of its task, notes when the command starts and ends, stops it ahead of the time
/// limit, and queues it again if it was stopped or killed.
std::string task_script(const FarmPlan& plan, const SlurmParams& params);

/// Returns the script that submits all jobs and notes their numbers. SIGTERM stops it before the next job. It
/// needs task_script() as `task.sh` and the lists as `tasks/NAME` in the folder of the shot.
std::string submit_script(const FarmPlan& plan, const std::vector<SlurmJob>& jobs, const SlurmParams& params);

}  // namespace pelage
