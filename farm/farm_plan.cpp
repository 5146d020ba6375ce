// SPDX-License-Identifier: Apache-2.0
#include "farm/farm_plan.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>

#include "world/frames.h"

namespace pelage {
namespace {

constexpr int kBlock = 16;  // pixels

/// Borders of `count` parts of a side, or of fewer if there are not as many blocks.
std::vector<int> borders(int pixels, int count) {
  const int blocks = (pixels + kBlock - 1) / kBlock;
  const int parts = std::clamp(count, 1, blocks);
  std::vector<int> result;
  for (int i = 0; i <= parts; ++i)
    result.push_back(std::min(pixels, static_cast<int>(int64_t{blocks} * i / parts) * kBlock));
  return result;
}

void append(std::vector<std::string>& command, const std::vector<std::string>& more) {
  command.insert(command.end(), more.begin(), more.end());
}

std::string in_folder(const FarmRequest& request, const std::string& place) {
  return (std::filesystem::path(request.folder) / place).string();
}

/// Writes a name so that frame_file_name() returns it unchanged.
std::string percent_escaped(const std::string& name) {
  std::string result;
  for (const char c : name) result += c == '%' ? std::string("%%") : std::string(1, c);
  return result;
}

/// Fills the caches of the scene, and measures the boxes of a frame.
FarmTask grow_task(const FarmRequest& request, const std::string& name, int frame) {
  FarmTask task;
  task.name = name;
  task.command = {request.program, "grow", request.scene};
  append(task.command, request.arguments);
  append(task.command, {"--frames", fmt::format("{}", frame)});
  append(task.command, request.flags);
  task.memory = request.memory;
  return task;
}

/// Makes the motion that growing and rendering read.
FarmTask simulate_task(const FarmRequest& request) {
  FarmTask task;
  task.name = "simulate";
  task.command = {request.program, "simulate", request.scene};
  append(task.command, request.arguments);
  append(task.command, {"--frames", request.simulates});
  append(task.command, request.flags);
  task.memory = request.memory;
  return task;
}

/// Name of the task after which frames can be rendered; empty: none.
std::string first_task(const FarmRequest& request) {
  return request.grows ? "grow" : request.simulates.empty() ? "" : "simulate";
}

FarmTask render_task(const FarmRequest& request, int frame, const std::string& suffix,
                     const std::optional<PixelBox>& region, const std::string& output,
                     const std::string& after) {
  FarmTask task;
  const std::string name = fmt::format("{:04}{}", frame, suffix);
  task.name = "render-" + name;
  task.frame = frame;
  task.region = region;
  task.output = output;
  if (!after.empty()) task.after = {after};
  task.command = {request.program, "render", request.scene};
  append(task.command, request.arguments);
  append(task.command, {"--frames", fmt::format("{}", frame), "-o", percent_escaped(output)});
  if (region)
    append(task.command,
           {"--region", fmt::format("{},{},{},{}", region->x0, region->y0, region->x1, region->y1)});
  if (request.saves) {
    append(task.command, {"--checkpoint", in_folder(request, "checkpoints"), "--every",
                          fmt::format("{}s", request.every_s), "--resume"});
  } else {
    task.command.emplace_back("--skip-existing");
  }
  append(task.command, {"--stats", in_folder(request, "stats/" + name + ".json")});
  append(task.command, request.flags);
  task.memory = request.memory;
  return task;
}

void add_regions(const FarmRequest& request, int frame, const std::vector<PixelBox>& boxes,
                 std::vector<FarmTask>& tasks) {
  std::string grown = first_task(request);
  if (request.grows && frame != request.frames.front()) {
    grown = fmt::format("grow-{:04}", frame);
    tasks.push_back(grow_task(request, grown, frame));
    tasks.back().after = {"grow"};
  }
  FarmTask merge;
  merge.name = fmt::format("merge-{:04}", frame);
  merge.frame = frame;
  merge.output = frame_file_name(request.output, frame);
  merge.command = {request.program, "merge"};
  const auto columns = static_cast<size_t>(
      std::count_if(boxes.begin(), boxes.end(), [](const PixelBox& box) { return box.y0 == 0; }));
  for (size_t i = 0; i < boxes.size(); ++i) {
    const std::string suffix = fmt::format("-r{}c{}", i / columns, i % columns);
    const std::string piece = in_folder(request, fmt::format("pieces/{:04}{}.exr", frame, suffix));
    tasks.push_back(render_task(request, frame, suffix, boxes[i], piece, grown));
    merge.after.push_back(tasks.back().name);
    merge.command.push_back(piece);
  }
  append(merge.command, {"-o", merge.output});
  append(merge.command, request.flags);
  tasks.push_back(std::move(merge));
}

}  // namespace

std::vector<PixelBox> divide_picture(int width, int height, int columns, int rows) {
  const std::vector<int> x = borders(width, columns), y = borders(height, rows);
  std::vector<PixelBox> boxes;
  for (size_t j = 0; j + 1 < y.size(); ++j) {
    for (size_t i = 0; i + 1 < x.size(); ++i) boxes.push_back({x[i], y[j], x[i + 1], y[j + 1]});
  }
  return boxes;
}

std::vector<FarmTask> make_farm_plan(const FarmRequest& request) {
  const std::vector<PixelBox> boxes =
      divide_picture(request.width, request.height, request.columns, request.rows);
  std::vector<FarmTask> tasks;
  if (!request.simulates.empty()) tasks.push_back(simulate_task(request));
  if (request.grows) {
    tasks.push_back(grow_task(request, "grow", request.frames.front()));
    if (!request.simulates.empty()) tasks.back().after = {"simulate"};
  }
  for (const int frame : request.frames) {
    if (boxes.size() > 1) {
      add_regions(request, frame, boxes, tasks);
    } else {
      tasks.push_back(
          render_task(request, frame, "", {}, frame_file_name(request.output, frame), first_task(request)));
    }
  }
  return tasks;
}

}  // namespace pelage
