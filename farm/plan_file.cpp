// SPDX-License-Identifier: Apache-2.0
#include "farm/plan_file.h"

#include <set>

#include <nlohmann/json.hpp>

#include "base/error.h"

namespace pelage {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const FarmTask& task, int threads) {
  Json json{{"name", task.name}, {"command", task.command}, {"after", task.after}};
  if (task.frame) json["frame"] = *task.frame;
  if (task.region) json["region"] = {task.region->x0, task.region->y0, task.region->x1, task.region->y1};
  if (!task.output.empty()) json["output"] = task.output;
  if (task.memory > 0) json["memory"] = task.memory;
  if (threads > 0) json["threads"] = threads;
  return json;
}

/// A name becomes the name of a file.
bool is_plain_name(const std::string& name) {
  return !name.empty() &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos;
}

FarmTask task_of(const Json& json) {
  FarmTask task;
  task.name = json.at("name").get<std::string>();
  task.command = json.at("command").get<std::vector<std::string>>();
  task.after = json.at("after").get<std::vector<std::string>>();
  if (json.contains("frame")) task.frame = json["frame"].get<int>();
  if (json.contains("region")) {
    const auto sides = json["region"].get<std::array<int, 4>>();
    task.region = PixelBox{sides[0], sides[1], sides[2], sides[3]};
  }
  task.output = json.value("output", "");
  task.memory = json.value("memory", uint64_t{0});
  return task;
}

}  // namespace

std::string plan_json(const FarmPlan& plan) {
  Json json{{"plan", 1}, {"folder", plan.folder.string()}};
  json["tasks"] = Json::array();
  for (const FarmTask& task : plan.tasks) json["tasks"].push_back(json_of(task, plan.threads));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

FarmPlan parse_plan(const std::string& text, const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorKind::kInput, {path.string(), 0, 0}, "is not a plan of a shot: " + why);
  };
  FarmPlan plan;
  try {
    const Json json = Json::parse(text);
    if (json.at("plan").get<int>() != 1) refuse("its version is not 1");
    plan.folder = json.at("folder").get<std::string>();
    std::set<std::string> names;
    for (const Json& task : json.at("tasks")) {
      plan.tasks.push_back(task_of(task));
      const FarmTask& added = plan.tasks.back();
      if (!is_plain_name(added.name) || !names.insert(added.name).second)
        refuse("the name of a task is not valid: " + added.name);
      for (const std::string& before : added.after) {
        if (before == added.name || !names.contains(before))
          refuse("task " + added.name + " comes after " + before + ", which is not before it in the list");
      }
      if (added.region && !added.frame) refuse("task " + added.name + " has a region but no frame");
      plan.threads = task.value("threads", 0);
    }
  } catch (const Json::exception& error) {
    refuse(error.what());
  }
  return plan;
}

}  // namespace pelage
