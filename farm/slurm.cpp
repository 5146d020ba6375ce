// SPDX-License-Identifier: Apache-2.0
#include "farm/slurm.h"

#include <algorithm>
#include <set>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/counted.h"
#include "base/error.h"
#include "base/file.h"
#include "base/process.h"
#include "base/program.h"
#include "farm/shot_page.h"

namespace pelage {
namespace {

namespace fs = std::filesystem;

/// Runs a program of Slurm. Variables by which a user can filter jobs or format lists do not reach it.
ProcessResult run_slurm(const std::string& program, std::vector<std::string> arguments) {
  const auto path = find_program(program);
  if (!path) throw Error(ErrorKind::kFailed, program + " is not in PATH: this machine has no Slurm");
  arguments.insert(arguments.begin(), path->string());
  ProcessSetup setup{std::move(arguments)};
  setup.environment = {"SQUEUE_*", "SCANCEL_*"};
  ProcessLimits limits;
  limits.seconds = 60;
  return run_process(setup, limits);
}

std::string last_line(std::string_view text) {
  constexpr size_t kLongest = 400;
  text = text.substr(0, text.find_last_not_of('\n') + 1);
  text.remove_prefix(text.rfind('\n') + 1);
  return std::string(text.substr(0, kLongest));
}

std::set<int64_t> jobs_in_queue(const fs::path& folder, const QueuedElements& queue) {
  const std::vector<int64_t> numbers = read_job_numbers(folder);
  std::set<int64_t> found;
  for (const auto& [element, state] : queue) {
    if (std::binary_search(numbers.begin(), numbers.end(), element.first)) found.insert(element.first);
  }
  return found;
}

/// Cancels jobs with as few commands as possible: one that fails is repeated for each half of its jobs.
class Cancelling {
 public:
  void cancel(std::span<const int64_t> jobs) {
    constexpr size_t kIds = 5000;  // of one command, whose text the system limits
    for (; jobs.size() > kIds; jobs = jobs.subspan(kIds)) cancel_some(jobs.first(kIds));
    if (!jobs.empty()) cancel_some(jobs);
  }

  std::vector<int64_t> failed;
  std::string message;  ///< last line of the last command that failed for a single job

 private:
  void cancel_some(std::span<const int64_t> jobs) {
    std::vector<std::string> numbers;
    for (const int64_t job : jobs) numbers.push_back(std::to_string(job));
    const ProcessResult result = run_slurm("scancel", std::move(numbers));
    if (result.end.succeeded()) return;
    if (const size_t half = jobs.size() / 2; half > 0) {
      cancel_some(jobs.first(half));
      cancel_some(jobs.subspan(half));
      return;
    }
    failed.push_back(jobs.front());
    message = last_line(result.errors);
  }
};

constexpr const char* kFolders[] = {"state", "logs", "tasks", "stats", "checkpoints", "pieces"};

/// Refuses symbolic links in the folder of a shot. Scripts and Slurm would follow them, so whoever made a
/// link would choose the file that is overwritten.
void refuse_links(const fs::path& folder) {
  std::error_code ignored;
  const auto check = [&](const fs::path& path) {
    if (fs::is_symlink(path, ignored))
      throw Error(ErrorKind::kInput, {path.string(), 0, 0},
                  "is a symbolic link; Pelage follows none inside the folder of a shot");
  };
  for (const char* name : {"jobs", "submit.log"}) check(folder / name);
  for (const char* name : kFolders) {
    check(folder / name);
    std::error_code failed;
    for (fs::directory_iterator at(folder / name, failed), end; !failed && at != end; at.increment(failed)) {
      if (at->is_symlink(ignored)) check(at->path());
    }
  }
}

void write_shot(const SlurmShot& shot) {
  const fs::path folder = shot.params.folder;
  const auto write = [&](const fs::path& name, const std::string& text) {
    write_file(folder / name, text, Links::kReplace);
  };
  for (const char* name : kFolders) make_own_folder(folder / name);
  write("plan.json", plan_json(shot.plan));
  write("task.sh", task_script(shot.plan, shot.params));
  for (const SlurmJob& job : shot.jobs) write("tasks/" + job.name, task_list(shot.plan, job));
  write("submit.sh", submit_script(shot.plan, shot.jobs, shot.params));
}

/// Cancels the jobs that a stopped submission has already submitted.
[[noreturn]] void undo_submission(const fs::path& folder) {
  std::string undone;
  try {
    undone = counted(static_cast<int64_t>(cancel_in_slurm(folder)), "submitted job") + " cancelled";
  } catch (const Error& error) {
    undone = std::string("submitted jobs may still be in the queue: ") + error.what();
  }
  throw Error(ErrorKind::kStopped, "stopped; " + undone + "; `pelage farm submit` continues the shot");
}

/// Frames without checkpoints are finished when their pictures are there, whatever made these.
void refuse_old_pictures(const FarmPlan& plan) {
  for (const FarmTask& task : plan.tasks) {
    std::error_code ignored;
    const bool skips =
        std::find(task.command.begin(), task.command.end(), "--skip-existing") != task.command.end();
    if (skips && fs::exists(plan.folder / task.output, ignored))
      throw Error(ErrorKind::kArguments,
                  task.output + " exists, so this frame would count as finished, because " +
                      "frames of this scene have no checkpoints; remove it, or use another -o");
  }
}

bool was_submitted(const fs::path& folder) {
  std::error_code none;
  const auto bytes = fs::file_size(folder / "jobs", none);
  return !none && bytes > 0;
}

}  // namespace

fs::path shot_folder(const fs::path& given) {
  const fs::path folder = fs::absolute(given).lexically_normal();
  return folder.has_filename() ? folder : folder.parent_path();
}

std::optional<QueuedElements> ask_slurm(const fs::path& folder) {
  if (!find_program("squeue")) return {};
  struct stat jobs {};
  const uid_t owner = ::lstat((folder / "jobs").c_str(), &jobs) == 0 ? jobs.st_uid : ::geteuid();
  const ProcessResult result =
      run_slurm("squeue", {"-h", "-r", "-u", std::to_string(owner), "-o", "%F %K %T"});
  if (!result.end.succeeded()) return {};
  return parse_queue(result.output);
}

void check_can_submit(const fs::path& folder) {
  if (!find_program("sbatch")) {
    throw Error(ErrorKind::kFailed,
                "sbatch is not in PATH: this machine has no Slurm; `pelage farm plan` prints the tasks for "
                "other queues");
  }
  refuse_links(folder);
  if (!was_submitted(folder)) return;
  const auto queue = ask_slurm(folder);
  if (!queue) {
    throw Error(ErrorKind::kFailed,
                folder.string() +
                    ": the queue does not answer whether earlier jobs of this shot are still "
                    "in it; try again, or use another --dir");
  }
  if (!jobs_in_queue(folder, *queue).empty()) {
    throw Error(ErrorKind::kArguments,
                folder.string() + ": jobs of this shot are still in the queue; `pelage farm cancel " +
                    folder.string() + "` ends them, or use another --dir");
  }
}

void check_same_shot(const fs::path& folder, const FarmPlan& plan) {
  if (!was_submitted(folder)) return refuse_old_pictures(plan);
  if (std::error_code ignored; !fs::exists(folder / "plan.json", ignored)) return;
  const FarmPlan before = read_plan(folder);
  // A plan that has been written has no bytes that are not UTF-8.
  const std::string differences = plan_differences(before, parse_plan(plan_json(plan), folder));
  if (differences.empty()) return;
  throw Error(ErrorKind::kArguments,
              folder.string() + ": the folder has another shot, because these differ: " + differences +
                  "; use another --dir, or remove the folder");
}

std::string script_text(const SlurmShot& shot) {
  const auto& [plan, params, jobs] = shot;
  std::string text = "# " + params.folder + "/task.sh\n" + task_script(plan, params) + "\n";
  for (const SlurmJob& job : jobs)
    text += "# " + params.folder + "/tasks/" + job.name + "\n" + task_list(plan, job) + "\n";
  return text + "# " + params.folder + "/submit.sh\n" + submit_script(plan, jobs, params);
}

void submit_to_slurm(const SlurmShot& shot, const std::function<bool()>& cancelled) {
  write_shot(shot);
  const fs::path folder = shot.params.folder;
  ProcessSetup setup{{"/bin/bash", (folder / "submit.sh").string()}};
  setup.log = folder / "submit.log";
  ProcessLimits limits;
  limits.cancelled = cancelled;
  limits.kill_delay_s = kNoLimit_s;  // the script ends as soon as it has noted the present job
  const ProcessEnd end = run_process(setup, limits).end;
  if (end.interrupted) undo_submission(folder);
  if (end.succeeded()) return;
  throw Error(ErrorKind::kFailed, "Slurm did not accept all jobs: " + last_line(end_of_log(setup.log)) +
                                      "; `pelage farm cancel " + folder.string() +
                                      "` cancels those that it did");
}

size_t cancel_in_slurm(const fs::path& folder) {
  read_shot_state(folder, {}, 0);  // refuses other folders
  if (!find_program("scancel"))
    throw Error(ErrorKind::kFailed, "scancel is not in PATH: this machine has no Slurm");
  const std::optional<QueuedElements> queue = ask_slurm(folder);
  if (!queue) throw Error(ErrorKind::kFailed, "the queue does not answer; nothing was cancelled");
  const std::set<int64_t> queued = jobs_in_queue(folder, *queue);
  const std::vector<int64_t> jobs(queued.begin(), queued.end());
  Cancelling cancelling;
  cancelling.cancel(jobs);
  if (!cancelling.failed.empty()) {
    if (const auto now = ask_slurm(folder)) {  // jobs may have ended before they were cancelled
      const std::set<int64_t> left = jobs_in_queue(folder, *now);
      std::erase_if(cancelling.failed, [&](int64_t job) { return !left.contains(job); });
    }
  }
  if (const size_t failed = cancelling.failed.size(); failed > 0) {
    throw Error(ErrorKind::kFailed, fmt::format("{} cancelled, but scancel failed for {}: {}",
                                                counted(static_cast<int64_t>(jobs.size() - failed), "job"),
                                                fmt::join(cancelling.failed, ", "), cancelling.message));
  }
  return jobs.size();
}

}  // namespace pelage
