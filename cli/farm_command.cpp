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
#include "farm/shot_cost.h"
#include "farm/shot_page.h"
#include "farm/slurm.h"

namespace pelage {
namespace {

namespace fs = std::filesystem;

int plan_shot(const Options& options) {
  // --progress sets the style of the tasks; this command itself shows plain progress or none.
  const bool quiet = options.progress == ProgressStyle::kQuiet;
  ProgressDisplay display(quiet ? ProgressStyle::kQuiet : ProgressStyle::kPlain, [] { return false; });
  const SceneDescription scene = read_scene(options, display);
  const FarmPlan plan{fs::current_path(), options.threads, make_farm_plan(farm_request(options, scene))};
  if (options.farm.json) {
    std::cout << plan_json(plan);
  } else {
    for (const FarmTask& task : plan.tasks) std::cout << shell_line(task.command) << "\n";
  }
  return 0;
}

RunEstimate estimate_shot(const Options& options, const SceneDescription& scene) {
  Options quiet = options;
  quiet.progress = options.progress == ProgressStyle::kQuiet ? ProgressStyle::kQuiet : ProgressStyle::kPlain;
  Run run(quiet);
  return estimate_run(scene, frames_to_estimate(scene.frames.frames), {}, run.job());
}

SlurmParams slurm_params(const FarmOptions& options, const fs::path& folder, const RunEstimate& estimate) {
  SlurmParams params;
  params.folder = folder.string();
  params.render_bytes = reserved_bytes(estimate);
  params.retries = options.retries;
  if (!options.partition.empty()) params.options.push_back("--partition=" + options.partition);
  if (!options.time.empty()) params.options.push_back("--time=" + options.time);
  params.options.insert(params.options.end(), options.sbatch.begin(), options.sbatch.end());
  return params;
}

void print_submitted(const std::string& folder, const SlurmShot& shot, const ShotCost& cost, bool saves) {
  std::cout << fmt::format("{}: {} in {}; {} reserved for each render, about {} of CPU time in all\n",
                           shot.params.folder, counted(static_cast<int64_t>(shot.plan.tasks.size()), "task"),
                           counted(static_cast<int64_t>(shot.jobs.size()), "job"),
                           memory_text(static_cast<int64_t>(shot.params.render_bytes)),
                           duration_text(cost.whole_s + cost.repeated_s));
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
  shot.plan = {fs::current_path(), options.threads, make_farm_plan(request)};
  const RunEstimate estimate = estimate_shot(options, scene);
  shot.params = slurm_params(options.farm, folder, estimate);
  shot.jobs = slurm_jobs(shot.plan);
  if (options.farm.dry_run) {
    std::cout << script_text(shot);
    return 0;
  }
  submit_to_slurm(shot, &SignalGuard::interrupted);
  const bool stores = !scene.render.bvh.file.empty();
  print_submitted(options.farm.folder, shot, shot_cost(request, estimate, stores), request.grows && stores);
  return 0;
}

int show_shot(const Options& options) {
  const fs::path folder = shot_folder(options.input);
  const auto now = static_cast<int64_t>(std::time(nullptr));
  const ShotState shot = read_shot_state(folder, ask_slurm(folder), now);
  const fs::path page = folder / "index.html";
  write_file(page, shot_page(shot, folder, update_thumbnails(shot, folder), now));
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
