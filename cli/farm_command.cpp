// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>

#include "cli/commands.h"
#include "cli/farm_request.h"
#include "cli/farm_slurm.h"
#include "cli/progress_display.h"
#include "cli/read_scene.h"
#include "farm/plan_file.h"

namespace pelage {
namespace {

int plan_shot(const Options& options) {
  // --progress sets the style of the tasks; this command itself shows plain progress or none.
  const bool quiet = options.progress == ProgressStyle::kQuiet;
  ProgressDisplay display(quiet ? ProgressStyle::kQuiet : ProgressStyle::kPlain, [] { return false; });
  const SceneDescription scene = read_scene(options, display);
  const FarmPlan plan{std::filesystem::current_path(), options.threads,
                      make_farm_plan(farm_request(options, scene))};
  if (options.farm.json) {
    std::cout << plan_json(plan);
  } else {
    for (const FarmTask& task : plan.tasks) std::cout << shell_line(task.command) << "\n";
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
      return cancel_shot(options);
  }
  return 2;
}

}  // namespace pelage
