// SPDX-License-Identifier: Apache-2.0
#include "cli/farm_slurm.h"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <set>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "base/counted.h"
#include "base/file.h"
#include "base/memory_budget.h"
#include "base/temporary_folder.h"
#include "cli/farm_request.h"
#include "cli/read_scene.h"
#include "cli/render_estimate.h"
#include "cli/run.h"
#include "farm/shot_page.h"
#include "farm/slurm_jobs.h"
#include "lab/runs/process.h"

namespace pelage {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kMebibyte = int64_t{1} << 20;
// Margin for memory that the estimate does not count: pages of files, and frames that are not estimated.
constexpr double kReserve = 1.2;
constexpr uint64_t kMergeBytes = 512 * kMebibyte;
constexpr double kQueue_s = 60;  // time limit of a command of Slurm

/// Runs a command of a shell and returns its output.
struct ShellResult {
  bool succeeded = false;
  std::string output;
};
ShellResult run_shell(const std::string& command) {
  const TemporaryFolder folder;
  const fs::path log = folder.path() / "log";
  const ProcessEnd end = run_process(
      {"/bin/sh", "-c", command}, log, [] { return false; }, kQueue_s);
  return {end.succeeded(), read_file(log)};
}

bool has_program(const std::string& name) { return run_shell("command -v " + name).succeeded; }

/// The folder of a shot, without a slash at its end.
fs::path folder_of_shot(const fs::path& given) {
  const fs::path folder = fs::absolute(given).lexically_normal();
  return folder.has_filename() ? folder : folder.parent_path();
}

/// The elements that the queue has of the user who submitted the shot; nothing where there is no Slurm, or it
/// does not answer.
std::optional<QueuedElements> ask_queue(const fs::path& folder) {
  if (!has_program("squeue")) return {};
  struct stat jobs {};
  const uid_t owner = ::stat((folder / "jobs").c_str(), &jobs) == 0 ? jobs.st_uid : ::geteuid();
  const ShellResult result = run_shell(fmt::format("squeue -h -r -u {} -o '%F %K %T' 2>/dev/null", owner));
  if (!result.succeeded) return {};
  return parse_queue(result.output);
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
    constexpr size_t kIds = 5000;  // of one command, whose text the system limits to 128 KiB
    for (; jobs.size() > kIds; jobs = jobs.subspan(kIds)) cancel_some(jobs.first(kIds));
    if (!jobs.empty()) cancel_some(jobs);
  }

  std::vector<int64_t> failed;
  std::string message;  ///< last line of the last command that failed for a single job

 private:
  void cancel_some(std::span<const int64_t> jobs) {
    const ShellResult result = run_shell(fmt::format("scancel {}", fmt::join(jobs, " ")));
    if (result.succeeded) return;
    if (const size_t half = jobs.size() / 2; half > 0) {
      cancel_some(jobs.first(half));
      cancel_some(jobs.subspan(half));
      return;
    }
    failed.push_back(jobs.front());
    const std::string text = result.output.substr(0, result.output.find_last_not_of('\n') + 1);
    message = text.substr(text.rfind('\n') + 1);
  }
};

/// The frames to estimate: the first, the middle and the last one.
std::vector<int> sampled_frames(const std::vector<int>& frames) {
  std::vector<int> sampled;
  for (const size_t i : {size_t(0), frames.size() / 2, frames.size() - 1}) {
    if (std::find(sampled.begin(), sampled.end(), frames[i]) == sampled.end()) sampled.push_back(frames[i]);
  }
  return sampled;
}

RunEstimate estimate_shot(const Options& options, const SceneDescription& scene) {
  Options quiet = options;
  quiet.progress = options.progress == ProgressStyle::kQuiet ? ProgressStyle::kQuiet : ProgressStyle::kPlain;
  Run run(quiet);
  return estimate_run(scene, sampled_frames(scene.frames.frames), {}, run);
}

SlurmParams slurm_params(const Options& options, const fs::path& folder, const RunEstimate& estimate) {
  SlurmParams params;
  params.folder = folder.string();
  params.render_bytes = static_cast<uint64_t>(kReserve * static_cast<double>(estimate.peak_bytes()));
  params.merge_bytes = kMergeBytes;
  params.retries = options.farm.retries;
  if (!options.farm.partition.empty()) params.options.push_back("--partition=" + options.farm.partition);
  if (!options.farm.time.empty()) params.options.push_back("--time=" + options.farm.time);
  params.options.insert(params.options.end(), options.farm.sbatch.begin(), options.farm.sbatch.end());
  return params;
}

/// CPU seconds of the shot, roughly.
struct ShotCost {
  double whole_s = 0;  ///< if its frames were not divided
  /// Max extra CPU seconds caused by regions, since each repeats start-up, bounding and growth.
  double repeated_s = 0;
};

/// CPU time of reading a chunk from render.bvh.file, as a fraction of growing it (docs/lab/FARM.md).
constexpr double kReading = 1.0 / 6;

ShotCost cost_of(const FarmRequest& request, const RunEstimate& estimate, bool stores) {
  const auto sampled = static_cast<double>(estimate.frames.size());
  double repeated_s = estimate.loading_cpu_s + estimate.posing_cpu_s / sampled;
  for (const FrameEstimate& frame : estimate.estimates)
    repeated_s += ((request.grows ? 0 : frame.measuring_cpu_s) +
                   (stores ? kReading : 1) * frame.growing_cpu_s + frame.shadows.cpu_s) /
                  sampled;
  const auto regions = divide_picture(request.width, request.height, request.columns, request.rows).size();
  const auto frames = static_cast<double>(request.frames.size());
  ShotCost cost;
  for (size_t i = 0; i < estimate.frames.size(); ++i) cost.whole_s += estimate.cpu_s(i) * frames / sampled;
  cost.repeated_s = repeated_s * static_cast<double>(regions - 1) * frames;
  return cost;
}

void print_submitted(const std::string& folder, const FarmPlan& plan, size_t jobs, const SlurmParams& params,
                     const ShotCost& cost, bool saves) {
  std::cout << fmt::format(
      "{}: {} in {}; {} reserved for each render, about {} of CPU time in all\n", params.folder,
      counted(static_cast<int64_t>(plan.tasks.size()), "task"), counted(static_cast<int64_t>(jobs), "job"),
      memory_text(static_cast<int64_t>(params.render_bytes)), duration_text(cost.whole_s + cost.repeated_s));
  constexpr double kMuch = 0.1;
  if (!saves && cost.repeated_s > kMuch * cost.whole_s) {
    std::cout << fmt::format(
        "up to {:.0f} % of the CPU time is what regions repeat; a `cache` in each groom and render.bvh.file "
        "save most of it\n",
        100 * cost.repeated_s / (cost.whole_s + cost.repeated_s));
  }
  std::cout << "pelage farm status " << shell_line({folder}) << "\n";
}

void print_scripts(const FarmPlan& plan, const std::vector<SlurmJob>& jobs, const SlurmParams& params) {
  std::cout << "# " << params.folder << "/task.sh\n" << task_script(params) << "\n";
  for (const SlurmJob& job : jobs)
    std::cout << "# " << params.folder << "/tasks/" << job.name << "\n" << task_list(plan, job) << "\n";
  std::cout << "# " << params.folder << "/submit.sh\n" << submit_script(plan, jobs, params);
}

void write_shot(const fs::path& folder, const FarmPlan& plan, const std::vector<SlurmJob>& jobs,
                const SlurmParams& params) {
  for (const char* name : {"state", "logs", "tasks"}) fs::create_directories(folder / name);
  write_file(folder / "plan.json", plan_json(plan));
  write_file(folder / "task.sh", task_script(params));
  for (const SlurmJob& job : jobs) write_file(folder / "tasks" / job.name, task_list(plan, job));
  write_file(folder / "submit.sh", submit_script(plan, jobs, params));
  write_file(folder / "reserved", std::to_string(params.render_bytes) + "\n");
}

/// Two jobs of the same shot would write the same checkpoints and pieces.
void check_free(const fs::path& folder) {
  std::error_code none;
  if (const auto bytes = fs::file_size(folder / "jobs", none); none || bytes == 0) return;
  const auto queue = ask_queue(folder);
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

nlohmann::ordered_json json_of(const FarmTask& task, const TaskState& state) {
  nlohmann::ordered_json json{
      {"name", task.name}, {"state", stage_name(state.stage)}, {"starts", state.starts}};
  if (state.starts > 0) {
    json["busy_s"] = state.busy_s;
    json["host"] = state.host;
    json["log"] = state.log;
  }
  if (state.ended > 0) json["exit_code"] = state.exit_code;
  if (state.cpu_s > 0) json["cpu_s"] = state.cpu_s;
  if (state.peak_bytes > 0) json["peak_rss_bytes"] = state.peak_bytes;
  return json;
}

void print_json(const ShotState& shot) {
  nlohmann::ordered_json json{{"status", 1}};
  for (int s = 0; s <= static_cast<int>(TaskStage::kLost); ++s)
    json["counts"][std::string(stage_name(static_cast<TaskStage>(s)))] =
        shot.count(static_cast<TaskStage>(s));
  for (size_t i = 0; i < shot.tasks.size(); ++i)
    json["tasks"].push_back(json_of(shot.plan.tasks[i], shot.tasks[i]));
  std::cout << json.dump(2) << "\n";
}

void print_text(const ShotState& shot, const fs::path& folder) {
  std::string counts;
  for (int s = 0; s <= static_cast<int>(TaskStage::kLost); ++s) {
    const auto stage = static_cast<TaskStage>(s);
    if (const int64_t count = shot.count(stage); count > 0)
      counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, stage_name(stage));
  }
  std::cout << counted(static_cast<int64_t>(shot.tasks.size()), "task") << ": " << counts << "\n";
  for (size_t i = 0; i < shot.tasks.size(); ++i) {
    const TaskState& task = shot.tasks[i];
    const bool quiet = task.stage == TaskStage::kDone || task.stage == TaskStage::kWaiting;
    if (quiet && task.starts < 2) continue;
    std::cout << fmt::format("{}: {}", shot.plan.tasks[i].name, stage_name(task.stage));
    if (task.starts > 0) std::cout << fmt::format(", {} on {}", duration_text(task.busy_s), task.host);
    if (task.starts > 1) std::cout << fmt::format(", started {} times", task.starts);
    if (task.stage == TaskStage::kFailed) std::cout << fmt::format(", exit code {}", task.exit_code);
    std::cout << "\n";
    if (task.stage != TaskStage::kFailed) continue;
    const std::string log = (folder / task.log).string(), end = end_of_log(log);
    std::cout << fmt::format("  {}: {}\n", log, end.substr(end.rfind('\n') + 1));
  }
}

}  // namespace

int submit_shot(const Options& options) {
  const fs::path folder = folder_of_shot(options.farm.folder);
  if (!options.farm.dry_run && !has_program("sbatch")) {
    throw Error(ErrorKind::kFailed,
                "sbatch is not in PATH: this machine has no Slurm; `pelage farm plan` prints the tasks for "
                "other queues");
  }
  if (!options.farm.dry_run) check_free(folder);
  ProgressDisplay display(ProgressStyle::kQuiet, [] { return false; });
  const SceneDescription scene = read_scene(options, display);
  FarmRequest request = farm_request(options, scene);
  request.program = current_executable().string();
  const FarmPlan plan{fs::current_path(), options.threads, make_farm_plan(request)};
  const RunEstimate estimate = estimate_shot(options, scene);
  const SlurmParams params = slurm_params(options, folder, estimate);
  const std::vector<SlurmJob> jobs = slurm_jobs(plan);
  if (options.farm.dry_run) {
    print_scripts(plan, jobs, params);
    return 0;
  }
  write_shot(folder, plan, jobs, params);
  const fs::path log = folder / "submit.log";
  const ProcessEnd end =
      run_process({"/bin/bash", (folder / "submit.sh").string()}, log, &SignalGuard::interrupted);
  if (!end.succeeded()) {
    const std::string said = end_of_log(log);
    throw Error(ErrorKind::kFailed, "Slurm did not accept all jobs: " + said.substr(said.rfind('\n') + 1) +
                                        "; `pelage farm cancel " + folder.string() +
                                        "` cancels those that it did");
  }
  const bool stores = !scene.render.bvh.file.empty();
  print_submitted(options.farm.folder, plan, jobs.size(), params, cost_of(request, estimate, stores),
                  request.grows && stores);
  return 0;
}

int show_shot(const Options& options) {
  const fs::path folder = folder_of_shot(options.input);
  const auto now = static_cast<int64_t>(std::time(nullptr));
  const ShotState shot = read_shot_state(folder, ask_queue(folder), now);
  const fs::path page = folder / "index.html";
  write_file(page, shot_page(shot, folder, update_thumbnails(shot, folder), now));
  if (options.farm.json) {
    print_json(shot);
  } else {
    print_text(shot, folder);
    std::cout << page.string() << "\n";
  }
  return 0;
}

int cancel_shot(const Options& options) {
  const fs::path folder = folder_of_shot(options.input);
  read_shot_state(folder, {}, 0);  // refuses other folders
  if (!has_program("scancel"))
    throw Error(ErrorKind::kFailed, "scancel is not in PATH: this machine has no Slurm");
  const std::optional<QueuedElements> queue = ask_queue(folder);
  if (!queue) throw Error(ErrorKind::kFailed, "the queue does not answer; nothing was cancelled");
  const std::set<int64_t> queued = jobs_in_queue(folder, *queue);
  const std::vector<int64_t> jobs(queued.begin(), queued.end());
  Cancelling cancelling;
  cancelling.cancel(jobs);
  if (!cancelling.failed.empty()) {
    if (const auto now = ask_queue(folder)) {  // jobs may have ended before they were cancelled
      const std::set<int64_t> left = jobs_in_queue(folder, *now);
      std::erase_if(cancelling.failed, [&](int64_t job) { return !left.contains(job); });
    }
  }
  if (const size_t failed = cancelling.failed.size(); failed > 0) {
    throw Error(ErrorKind::kFailed, fmt::format("{} cancelled, but scancel failed for {}: {}",
                                                counted(static_cast<int64_t>(jobs.size() - failed), "job"),
                                                fmt::join(cancelling.failed, ", "), cancelling.message));
  }
  std::cout << counted(static_cast<int64_t>(jobs.size()), "job") << " cancelled\n";
  return 0;
}

}  // namespace pelage
