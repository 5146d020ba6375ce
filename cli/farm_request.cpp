// SPDX-License-Identifier: Apache-2.0
#include "cli/farm_request.h"

#include <filesystem>

#include <fmt/format.h>

#include "base/file.h"
#include "image/display_image.h"
#include "world/coat_motion.h"
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
  if (!options.rib_in.materials.empty())
    request.arguments.insert(request.arguments.end(), {"--materials", options.rib_in.materials});
  if (options.allow_scripts) request.arguments.emplace_back("--allow-scripts");
  if (options.rib_in.allow_procedurals) request.arguments.emplace_back("--allow-procedurals");
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
  if (has_simulated_coat(scene)) request.simulates = print_frames(scene.frames);
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
  if (lower_extension(request.output) != ".exr" && (pieces || !is_display_image(request.output))) {
    throw Error(ErrorKind::kArguments,
                "-o " + request.output + ": pictures are written as .exr" +
                    (pieces ? " when they are divided into regions" : ", .png or .jpg"));
  }
  check_output_pattern(request.output, scene.frames);
}

}  // namespace

FarmRequest farm_request(const Options& options, const SceneDescription& scene) {
  FarmRequest request = request_of(options, scene);
  check(request, scene);
  return request;
}

}  // namespace pelage
