// SPDX-License-Identifier: Apache-2.0
#include <ctime>
#include <filesystem>
#include <iostream>

#include <fmt/format.h>

#include "base/counted.h"
#include "base/file.h"
#include "base/memory_budget.h"
#include "base/program.h"
#include "cli/commands.h"
#include "cli/farm_request.h"
#include "cli/farm_status.h"
#include "cli/progress_display.h"
#include "cli/read_scene.h"
#include "cli/run.h"
#include "cli/signals.h"
#include "farm/shot_cost.h"
#include "farm/shot_page.h"
#include "farm/slurm.h"
#include "world/checkpoint.h"
#include "world/motion_files.h"

namespace pelage {
namespace {

namespace fs = std::filesystem;

RunEstimate estimate_shot(const Options& options, const SceneDescription& scene) {
  Options quiet = options;
  quiet.progress = options.progress == ProgressStyle::kQuiet ? ProgressStyle::kQuiet : ProgressStyle::kPlain;
  Run run(quiet);
  return estimate_run(scene, frames_to_estimate(scene.frames.frames), {}, run.job());
}

FarmPlan plan_of(const Options& options, const FarmRequest& request) {
  FarmPlan plan{fs::current_path(), options.threads, make_farm_plan(request)};
  plan.shot = options.farm.folder;
  plan.retries = options.farm.retries;
  return plan;
}

/// Adds what the tasks will take, and returns it in parts.
ShotCost add_estimate(const Options& options, const FarmRequest& request, const SceneDescription& scene,
                      FarmPlan& plan) {
  const RunEstimate estimate = estimate_shot(options, scene);
  const ShotCost cost = shot_cost(request, estimate, !scene.render.bvh.file.empty());
  plan.estimate.render_bytes = reserved_bytes(estimate);
  plan.estimate.cpu_s = cost.whole_s + cost.repeated_s;
  return cost;
}

int plan_shot(const Options& options) {
  // --progress sets the style of the tasks; this command itself shows plain progress or none.
  const bool quiet = options.progress == ProgressStyle::kQuiet;
  ProgressDisplay display(quiet ? ProgressStyle::kQuiet : ProgressStyle::kPlain, [] { return false; });
  const SceneDescription scene = read_scene(options, display);
  const FarmRequest request = farm_request(options, scene);
  FarmPlan plan = plan_of(options, request);
  if (options.farm.json) {
    add_estimate(options, request, scene, plan);
    std::cout << plan_json(plan);
  } else {
    for (const FarmTask& task : plan.tasks) std::cout << shell_line(task.command) << "\n";
  }
  return 0;
}

SlurmParams slurm_params(const FarmOptions& options, const fs::path& folder) {
  SlurmParams params;
  params.folder = folder.string();
  if (!options.partition.empty()) params.options.push_back("--partition=" + options.partition);
  if (!options.time.empty()) params.options.push_back("--time=" + options.time);
  params.options.insert(params.options.end(), options.sbatch.begin(), options.sbatch.end());
  return params;
}

void print_submitted(const std::string& folder, const SlurmShot& shot, const ShotCost& cost, bool saves) {
  std::cout << fmt::format("{}: {} in {}; {} reserved for each render, about {} of CPU time in all\n",
                           shot.params.folder, counted(static_cast<int64_t>(shot.plan.tasks.size()), "task"),
                           counted(static_cast<int64_t>(shot.jobs.size()), "job"),
                           memory_text(static_cast<int64_t>(shot.plan.estimate.render_bytes)),
                           duration_text(shot.plan.estimate.cpu_s));
  constexpr double kMuch = 0.1;
  if (!saves && cost.repeated_s > kMuch * cost.whole_s) {
    std::cout << fmt::format(
        "up to {:.0f} % of the CPU time is what regions repeat; a `cache` in each groom and render.bvh.file "
        "save most of it\n",
        100 * cost.repeated_s / (cost.whole_s + cost.repeated_s));
  }
  std::cout << "pelage farm status " << shell_line({folder}) << "\n";
}

int submit_shot(const Options& options) {
  const fs::path folder = shot_folder(options.farm.folder);
  if (!options.farm.dry_run) check_can_submit(folder);
  ProgressDisplay display(ProgressStyle::kQuiet, [] { return false; });
  const SceneDescription scene = read_scene(options, display);
  FarmRequest request = farm_request(options, scene);
  request.program = current_program().string();
  SlurmShot shot;
  shot.plan = plan_of(options, request);
  if (!options.farm.dry_run) {
    shot.plan.inputs = frame_inputs(scene);
    shot.plan.inputs.merge(motion_file_inputs(scene, scene.frames.frames));
    check_same_shot(folder, shot.plan);
  }
  const ShotCost cost = add_estimate(options, request, scene, shot.plan);
  shot.params = slurm_params(options.farm, folder);
  shot.jobs = slurm_jobs(shot.plan);
  if (options.farm.dry_run) {
    std::cout << script_text(shot);
    return 0;
  }
  {
    const SignalGuard signals(
        "\npelage: stopping after the present job, and cancelling all; press Ctrl-C again to quit now\n");
    submit_to_slurm(shot, &SignalGuard::interrupted);
  }
  print_submitted(options.farm.folder, shot, cost, request.grows && !scene.render.bvh.file.empty());
  return 0;
}

int show_shot(const Options& options) {
  const fs::path folder = shot_folder(options.input);
  const auto now = static_cast<int64_t>(std::time(nullptr));
  const ShotState shot = read_shot_state(folder, ask_slurm(folder), now);
  const fs::path page = folder / "index.html";
  write_file(page, shot_page(shot, folder, update_thumbnails(shot, folder), now), Links::kReplace);
  if (options.farm.json) {
    print_shot_json(shot);
  } else {
    print_shot_text(shot, folder);
    std::cout << page.string() << "\n";
  }
  return 0;
}

}  // namespace

int run_farm(const Options& options) {
  switch (options.farm.action) {
    case FarmAction::kPlan:
      return plan_shot(options);
    case FarmAction::kSubmit:
      return submit_shot(options);
    case FarmAction::kStatus:
      return show_shot(options);
    case FarmAction::kCancel:
      std::cout << counted(static_cast<int64_t>(cancel_in_slurm(shot_folder(options.input))), "job")
                << " cancelled\n";
      return 0;
  }
  return 2;
}

}  // namespace pelage
