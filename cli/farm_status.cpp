// SPDX-License-Identifier: Apache-2.0
#include "cli/farm_status.h"

#include <iostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "base/visible_text.h"
#include "cli/progress_display.h"
#include "farm/shot_page.h"

namespace pelage {
namespace {

nlohmann::ordered_json task_json(const FarmTask& task, const TaskState& state) {
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

}  // namespace

void print_shot_json(const ShotState& shot) {
  nlohmann::ordered_json json{{"status", 1}};
  for (int s = 0; s <= static_cast<int>(TaskStage::kLost); ++s)
    json["counts"][std::string(stage_name(static_cast<TaskStage>(s)))] =
        shot.count(static_cast<TaskStage>(s));
  for (size_t i = 0; i < shot.tasks.size(); ++i)
    json["tasks"].push_back(task_json(shot.plan.tasks[i], shot.tasks[i]));
  std::cout << json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
}

void print_shot_text(const ShotState& shot, const std::filesystem::path& folder) {
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
    if (task.starts > 0)
      std::cout << fmt::format(", {} on {}", duration_text(task.busy_s), visible(task.host));
    if (task.starts > 1) std::cout << fmt::format(", started {} times", task.starts);
    if (task.stage == TaskStage::kFailed) std::cout << fmt::format(", exit code {}", task.exit_code);
    std::cout << "\n";
    if (task.stage != TaskStage::kFailed) continue;
    const std::string log = (folder / task.log).string(), end = end_of_log(log);
    std::cout << fmt::format("  {}: {}\n", log, visible(end.substr(end.rfind('\n') + 1)));
  }
}

}  // namespace pelage
