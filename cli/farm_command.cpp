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
#include "render/render_frame.h"
#include "world/frames.h"

namespace pelage {
namespace {

FarmRequest request_of(const Options& options, const SceneDescription& scene) {
  FarmRequest request;
  request.scene = options.input;
  for (const Override& value : options.overrides) {
    if (value.key != "frames")
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
  request.threads = options.threads;
  request.saves = !scene.render.adaptive && scene.render.time_limit <= 0;
  for (const auto& groom : scene.grooms.items) request.grows = request.grows || groom.value.cache;
  return request;
}

void check(const FarmRequest& request, const SceneDescription& scene) {
  const bool pieces = request.columns * request.rows > 1;
  if (pieces) check_region(scene.image, scene.render, {0, 0, 1, 1});
  const std::string ending = std::filesystem::path(request.output).extension().string();
  if (ending != ".exr" && (pieces || !is_display_image(request.output))) {
    throw Error(ErrorKind::kArguments,
                "-o " + request.output + ": pictures are written as .exr" +
                    (pieces ? " when they are divided into regions" : ", .png or .jpg"));
  }
  check_output_pattern(request.output, scene.frames);
}

nlohmann::ordered_json json_of(const FarmTask& task) {
  nlohmann::ordered_json json{{"name", task.name}, {"command", task.command}, {"after", task.after}};
  if (task.frame) json["frame"] = *task.frame;
  if (task.region) json["region"] = {task.region->x0, task.region->y0, task.region->x1, task.region->y1};
  if (!task.output.empty()) json["output"] = task.output;
  return json;
}

std::string plan_json(const std::vector<FarmTask>& tasks) {
  nlohmann::ordered_json json{{"plan", 1}, {"folder", std::filesystem::current_path().string()}};
  for (const FarmTask& task : tasks) json["tasks"].push_back(json_of(task));
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace

int run_farm(const Options& options) {
  ProgressDisplay display(options.progress, [] { return false; });
  const SceneDescription scene = read_scene(options, display);
  const FarmRequest request = request_of(options, scene);
  check(request, scene);
  const std::vector<FarmTask> tasks = make_farm_plan(request);
  if (options.farm.json) {
    std::cout << plan_json(tasks);
  } else {
    for (const FarmTask& task : tasks) std::cout << shell_line(task.command) << "\n";
  }
  return 0;
}

}  // namespace pelage
