// SPDX-License-Identifier: Apache-2.0
// Tested in tests/cli/farm_test.py.
#include <filesystem>
#include <iostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/progress_display.h"
#include "cli/read_scene.h"
#include "farm/farm_plan.h"
#include "image/display_image.h"
#include "world/frames.h"

namespace pelage {
namespace {

constexpr size_t kMaxTasks = 1'000'000;

FarmRequest request_of(const Options& options, const SceneDescription& scene) {
  FarmRequest request;
  request.scene = options.input;
  for (const Override& value : options.overrides) {
    if (value.key != "frames")  // each task has --frames
      request.arguments.insert(request.arguments.end(), {"--set", value.key + "=" + value.value});
  }
  request.frames = scene.frames.frames;
  request.output = options.output;
  request.folder = options.farm.folder;
  request.width = scene.image.width;
  request.height = scene.image.height;
  request.columns = options.farm.columns;
  request.rows = options.farm.rows;
  request.every_s = options.farm.every_s;
  if (options.threads > 0) request.flags = {"--threads", std::to_string(options.threads)};
  if (const std::string style = progress_name(options.progress); !style.empty()) {
    request.flags.insert(request.flags.end(), {"--progress", style});
  } else if (options.progress == ProgressStyle::kQuiet) {
    request.flags.emplace_back("--quiet");
  }
  request.memory = scene.render.memory.bytes;
  request.saves = !scene.render.adaptive && scene.render.time_limit <= 0;
  for (const auto& groom : scene.grooms.items) request.grows = request.grows || groom.value.cache;
  return request;
}

// Regions that a run of the whole picture would sample otherwise.
void check_divisible(const RenderParams& render) {
  const auto refuse = [](const std::string& why) {
    throw Error(ErrorKind::kArguments, "--regions: " + why + "; without --regions, each frame is a task");
  };
  if (render.adaptive)
    refuse("with `adaptive` sampling, the sample count of a pixel depends on the whole picture");
  if (render.time_limit > 0) refuse("with `time_limit`, regions would have different sample counts");
}

void check(const FarmRequest& request, const SceneDescription& scene) {
  const bool pieces = request.columns * request.rows > 1;
  if (pieces) check_divisible(scene.render);
  const auto tasks = request.frames.size() * static_cast<size_t>(request.columns * request.rows);
  if (tasks > kMaxTasks) {
    throw Error(ErrorKind::kArguments,
                fmt::format("{} frames x {} regions are more than {} tasks; plan parts of the shot",
                            request.frames.size(), request.columns * request.rows, kMaxTasks));
  }
  const std::string ending = std::filesystem::path(request.output).extension().string();
  if (ending != ".exr" && (pieces || !is_display_image(request.output))) {
    throw Error(ErrorKind::kArguments,
                "-o " + request.output + ": pictures are written as .exr" +
                    (pieces ? " when they are divided into regions" : ", .png or .jpg"));
  }
  check_output_pattern(request.output, scene.frames);
}

nlohmann::ordered_json json_of(const FarmTask& task, int threads) {
  nlohmann::ordered_json json{{"name", task.name}, {"command", task.command}, {"after", task.after}};
  if (task.frame) json["frame"] = *task.frame;
  if (task.region) json["region"] = {task.region->x0, task.region->y0, task.region->x1, task.region->y1};
  if (!task.output.empty()) json["output"] = task.output;
  if (task.memory > 0) json["memory"] = task.memory;
  if (threads > 0) json["threads"] = threads;
  return json;
}

std::string plan_json(const std::vector<FarmTask>& tasks, int threads) {
  nlohmann::ordered_json json{{"plan", 1}, {"folder", std::filesystem::current_path().string()}};
  for (const FarmTask& task : tasks) json["tasks"].push_back(json_of(task, threads));
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace

int run_farm(const Options& options) {
  // --progress sets the style of the tasks; this command itself shows plain progress or none.
  const bool quiet = options.progress == ProgressStyle::kQuiet;
  ProgressDisplay display(quiet ? ProgressStyle::kQuiet : ProgressStyle::kPlain, [] { return false; });
  const SceneDescription scene = read_scene(options, display);
  const FarmRequest request = request_of(options, scene);
  check(request, scene);
  const std::vector<FarmTask> tasks = make_farm_plan(request);
  if (options.farm.json) {
    std::cout << plan_json(tasks, options.threads);
  } else {
    for (const FarmTask& task : tasks) std::cout << shell_line(task.command) << "\n";
  }
  return 0;
}

}  // namespace pelage
