// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "farm/shot_state.h"
#include "farm/slurm_jobs.h"

namespace pelage {

// What a shot does with the programs of Slurm: sbatch, squeue and scancel, which are looked for on PATH.

/// A shot as Slurm shall run it.
struct SlurmShot {
  FarmPlan plan;
  SlurmParams params;
  std::vector<SlurmJob> jobs;  ///< slurm_jobs() of the plan
};

/// Returns the folder of a shot in the form that scripts and messages use: absolute, without a slash at its
/// end.
std::filesystem::path shot_folder(const std::filesystem::path& given);

/// Returns the elements that the queue has of the user who submitted the shot. Returns nothing where there is
/// no Slurm, or if it does not answer.
std::optional<QueuedElements> ask_slurm(const std::filesystem::path& folder);

/// Throws Error if there is no Slurm (kFailed), if the folder contains a symbolic link (kInput), or if jobs
/// of the shot may still be in the queue (kArguments; kFailed if the queue does not answer): two jobs of the
/// same task would write the same files.
void check_can_submit(const std::filesystem::path& folder);

/// Throws Error (kArguments), and names what differs, if another shot was submitted in the folder: its
/// finished pictures would count as those of `plan`, and its checkpoints would stop the tasks. Also throws it
/// for the first submission of frames without checkpoints whose pictures are there already.
void check_same_shot(const std::filesystem::path& folder, const FarmPlan& plan);

/// Returns all scripts of a shot as one text, for people.
std::string script_text(const SlurmShot& shot);

/// Writes the plan and the scripts of a shot to its folder, and submits its jobs. When cancelled, waits until
/// Slurm has answered for the present job, cancels all jobs, and throws Error (kStopped). Throws Error
/// (kFailed) with the last line that Slurm printed.
void submit_to_slurm(const SlurmShot& shot, const std::function<bool()>& cancelled);

/// Cancels the jobs of a shot that have not ended, and returns their number. Throws Error: kInput if the
/// folder is not that of a shot, kFailed if Slurm does not answer or jobs could not be cancelled.
size_t cancel_in_slurm(const std::filesystem::path& folder);

}  // namespace pelage
