// SPDX-License-Identifier: Apache-2.0
#include "cli/frame_checkpoints.h"

#include <filesystem>

#include <fmt/format.h>

#include "base/error.h"
#include "cli/output_files.h"
#include "render/render_frame.h"
#include "world/motion_files.h"

namespace pelage {

FrameCheckpoints::FrameCheckpoints(const Options& options, const SceneDescription& scene, Progress& progress)
    : options_(options.checkpoint), region_(options.picture.region), scene_(scene), progress_(progress) {
  if (!options_.folder) return;
  check_saving(scene.render);
  for (const int frame : scene.frames.frames) {
    const auto file = std::filesystem::path(*options_.folder) / checkpoint_name(frame, region_);
    check_replaces_none("--checkpoint", file, scene.files);
  }
  if (std::error_code failed; options_.resume) {
    if (std::filesystem::exists(*options_.folder, failed))
      std::filesystem::directory_iterator(*options_.folder, failed);
    if (failed) throw Error(ErrorKind::kInput, {*options_.folder, 0, 0}, "cannot read: " + failed.message());
  }
  prepare_output(std::filesystem::path(*options_.folder) / "probe.checkpoint");
  inputs_ = frame_inputs(scene);
  signal_.emplace();
}

Checkpoint* FrameCheckpoints::of(int frame) {
  if (!options_.folder) return nullptr;
  std::unique_ptr<Checkpoint>& checkpoint = checkpoints_[frame];
  if (!checkpoint) {
    FrameInputs inputs = frame_inputs(inputs_, frame, region_);
    inputs.merge(motion_file_inputs(scene_, {&frame, 1}));
    checkpoint = std::make_unique<Checkpoint>(
        std::filesystem::path(*options_.folder) / checkpoint_name(frame, region_), std::move(inputs),
        Checkpoint::Schedule{options_.every_s, &CheckpointSignal::count}, progress_);
  }
  return checkpoint.get();
}

std::vector<int> FrameCheckpoints::unfinished(const std::vector<int>& frames,
                                              const std::function<std::string(int)>& picture) {
  if (!options_.resume) return frames;
  std::vector<int> left;
  for (const int frame : frames) {
    const Checkpoint::Found found = of(frame)->find(picture(frame));
    if (found != Checkpoint::Found::kPicture) left.push_back(frame);
    const std::string file = of(frame)->file().string();
    if (found == Checkpoint::Found::kPicture) {
      progress_.note(picture(frame) + "  is finished, skipped");
    } else if (found == Checkpoint::Found::kState) {
      progress_.note(file + "  is continued");
    } else {
      progress_.note(
          fmt::format("{}  has no state to continue from; the frame starts from the beginning", file));
    }
  }
  return left;
}

}  // namespace pelage
