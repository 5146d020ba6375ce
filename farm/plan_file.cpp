// SPDX-License-Identifier: Apache-2.0
#include "farm/plan_file.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "farm/slurm_jobs.h"
#include "world/frames.h"

namespace pelage {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMaxPlan = size_t(2) << 30;

Json json_of(const FarmTask& task, const FarmPlan& plan, const std::string& log) {
  Json json{{"name", task.name}, {"kind", task.kind()}, {"command", task.command}, {"after", task.after}};
  if (task.frame) json["frame"] = *task.frame;
  if (task.region) json["region"] = {task.region->x0, task.region->y0, task.region->x1, task.region->y1};
  if (!task.output.empty()) json["output"] = task.output;
  json["log"] = (std::filesystem::path(plan.shot) / log).string();
  if (task.memory > 0) json["memory"] = task.memory;
  if (plan.estimate.render_bytes > 0)
    json["reserve"] = task.kind() == "merge" ? plan.estimate.merge_bytes : plan.estimate.render_bytes;
  if (plan.threads > 0) json["threads"] = plan.threads;
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

/// What the pictures of a plan are, apart from their pixels.
struct PlanSummary {
  explicit PlanSummary(const FarmPlan& plan) {
    FrameList list{{}};
    int columns = 0, boxes = 0, width = 0, height = 0, top = 0;
    for (const FarmTask& task : plan.tasks) {
      if (!task.frame) continue;
      if (list.frames.empty() || list.frames.back() != *task.frame) list.frames.push_back(*task.frame);
      if (list.frames.size() > 1) continue;
      output =
          (plan.folder / task.output).lexically_normal().string();  // of the last task of the first frame
      if (!task.region) continue;
      if (boxes++ == 0)
        top = task.region->y0;  // of the first row, which a plan made by hand may begin anywhere
      columns += task.region->y0 == top;
      width = std::max(width, task.region->x1);
      height = std::max(height, task.region->y1);
    }
    frames = print_frames(list);
    constexpr size_t kLongest = 60;
    if (frames.size() > kLongest)
      frames = fmt::format("{}... ({})", frames.substr(0, kLongest), list.frames.size());
    regions = boxes == 0 ? "none"
                         : fmt::format("{}x{} of {} x {} pixels", columns, boxes / std::max(1, columns),
                                       width, height);
  }
  std::string frames, regions, output;
};

}  // namespace

std::string plan_differences(const FarmPlan& before, const FarmPlan& now) {
  std::string text;
  const auto compare = [&](const char* what, const std::string& old, const std::string& present) {
    if (old != present)
      text += fmt::format("{}{} ({} before, {} now)", text.empty() ? "" : ", ", what, old, present);
  };
  const PlanSummary a(before), b(now);
  compare("frames", a.frames, b.frames);
  compare("regions", a.regions, b.regions);
  if (a.frames == b.frames) compare("output", a.output, b.output);
  if (before.inputs.empty() || now.inputs.empty()) return text;
  FrameInputs inputs[] = {before.inputs, now.inputs};
  for (FrameInputs& own : inputs) own.erase("instructions");
  const std::string pixels = input_differences(inputs[0], inputs[1]);
  return text + (text.empty() || pixels.empty() ? "" : ", ") + pixels;
}

std::string plan_json(const FarmPlan& plan) {
  Json json{{"plan", 1}, {"folder", plan.folder.string()}, {"shot", plan.shot}};
  json["retry"] = {{"exit_codes", kRetriedCodes}, {"max", plan.retries}};
  if (const ShotEstimate& estimate = plan.estimate; estimate.render_bytes > 0) {
    json["estimate"] = {{"render_bytes", estimate.render_bytes},
                        {"merge_bytes", estimate.merge_bytes},
                        {"cpu_s", estimate.cpu_s}};
  }
  if (!plan.inputs.empty()) json["inputs"] = plan.inputs;
  json["tasks"] = Json::array();
  for (const SlurmJob& job : slurm_jobs(plan)) {  // in the order of the tasks
    for (size_t i = 0; i < job.tasks.size(); ++i)
      json["tasks"].push_back(json_of(plan.tasks[job.tasks[i]], plan, log_name(job, i)));
  }
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
    plan.shot = json.value("shot", "");
    if (json.contains("retry")) plan.retries = json["retry"].at("max").get<int>();
    if (json.contains("estimate")) {
      plan.estimate = {json["estimate"].at("render_bytes").get<uint64_t>(),
                       json["estimate"].at("merge_bytes").get<uint64_t>(),
                       json["estimate"].at("cpu_s").get<double>()};
    }
    if (json.contains("inputs")) plan.inputs = json["inputs"].get<FrameInputs>();
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

FarmPlan read_plan(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "plan.json";
  if (std::error_code error; !std::filesystem::exists(std::filesystem::symlink_status(file, error))) {
    throw Error(ErrorKind::kInput, {folder.string(), 0, 0},
                "is not the folder of a shot that `pelage farm submit` has made: it has no plan.json");
  }
  return parse_plan(read_file(file, kMaxPlan, OpenFile::Links::kRefuse), file);
}

}  // namespace pelage
