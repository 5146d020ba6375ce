// SPDX-License-Identifier: Apache-2.0
#include "world/checkpoint.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"
#include "base/program_identity.h"
#include "base/version.h"
#include "world/asset_files.h"

namespace pelage {
namespace {

constexpr const char* kPoses = "poses";
/// Parts of a scene that change no pixel.
constexpr std::array<std::string_view, 2> kIgnored = {"frames", "render.memory"};

}  // namespace

FrameInputs frame_inputs(const SceneDescription& scene) {
  FrameInputs inputs{{"version", std::string(version())},
                     {"build", program_identity()},
                     {"instructions", instruction_set()}};
  for (const auto& [part, hash] : scene.parts) {
    if (std::find(kIgnored.begin(), kIgnored.end(), part) == kIgnored.end())
      inputs["scene " + one_line(part)] = to_string(hash);
  }
  size_t number = 0;
  for (const std::filesystem::path& file : asset_files(scene)) {
    inputs[fmt::format("file {} {}", ++number, one_line(file.filename().string()))] =
        to_string(file_hash(file));
  }
  return inputs;
}

FrameInputs frame_inputs(const FrameInputs& scene, int frame, const std::optional<PixelBox>& region) {
  FrameInputs inputs = scene;
  inputs["frame"] = fmt::format("{}", frame);
  if (region) inputs["region"] = fmt::format("{},{},{},{}", region->x0, region->y0, region->x1, region->y1);
  return inputs;
}

std::string checkpoint_name(int frame, const std::optional<PixelBox>& region) {
  const std::string box =
      region ? fmt::format("-{}-{}-{}-{}", region->x0, region->y0, region->x1, region->y1) : "";
  return fmt::format("frame-{:04}{}.checkpoint", frame, box);
}

Checkpoint::Checkpoint(std::filesystem::path file, FrameInputs inputs, Schedule schedule, Progress& progress)
    : file_(std::move(file)),
      inputs_(std::move(inputs)),
      schedule_(std::move(schedule)),
      progress_(progress) {
  if (!schedule_.requests) schedule_.requests = [] { return 0u; };
  set_next();
}

Checkpoint::Found Checkpoint::find(const std::filesystem::path& picture) {
  std::error_code failed;
  const bool exists = std::filesystem::exists(file_, failed);
  if (failed) throw Error(ErrorKind::kInput, {file_.string(), 0, 0}, "cannot read: " + failed.message());
  if (!exists) return Found::kNothing;
  try {
    found_.emplace(file_);
  } catch (const Error& error) {
    progress_.warn(std::string(error.what()) + "; the frame is rendered from the beginning");
    return Found::kNothing;
  }
  compare(found_->record().inputs);
  if (!found_->record().picture) return Found::kState;
  bool same = false;
  try {
    same = file_hash(picture) == *found_->record().picture;
  } catch (const Error&) {
    // There is no picture any more.
  }
  if (same) return Found::kPicture;
  found_.reset();
  progress_.warn(fmt::format(
      "{}: missing or changed since it was finished; it is rendered from the beginning", picture.string()));
  return Found::kNothing;
}

void Checkpoint::compare(const FrameInputs& before) const {
  FrameInputs known = before;
  if (!inputs_.contains(kPoses)) known.erase(kPoses);
  const std::string differences = input_differences(known, inputs_);
  if (differences.empty()) return;
  throw Error(
      ErrorKind::kInput, {file_.string(), 0, 0},
      fmt::format("cannot continue this render, because these differ: {}; remove the file to start anew",
                  differences));
}

void Checkpoint::begin(const ContentHash& poses) {
  clock_ = Stopwatch();
  inputs_[kPoses] = to_string(poses);
  if (found_) compare(found_->record().inputs);
}

CheckpointRecord Checkpoint::record() const { return {inputs_, earlier_s_ + clock_.seconds()}; }

void Checkpoint::finish(const std::filesystem::path& picture) {
  CheckpointRecord done = record();
  done.picture = file_hash(picture);
  CheckpointFile::write(file_, done, {}, [&](const std::string& line) { progress_.warn(line); });
}

void Checkpoint::set_next() {
  const auto period =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(schedule_.every_s));
  next_ = (Clock::now() + period).time_since_epoch().count();
}

bool Checkpoint::due() const {
  return schedule_.requests() != requests_seen_ || Clock::now().time_since_epoch().count() >= next_;
}

void Checkpoint::save(const FrameState& state) {
  const uint32_t requests = schedule_.requests();
  const bool saved =
      CheckpointFile::write(file_, record(), state, [&](const std::string& line) { progress_.warn(line); });
  if (saved && requests != requests_seen_) progress_.note(file_.string() + "  saved");
  requests_seen_ = requests;
  set_next();
}

bool Checkpoint::restore(const FrameState& state) {
  set_next();
  if (!found_) return false;
  const bool fits = found_->copy_to(state);
  if (fits) {
    earlier_s_ = found_->record().seconds;
  } else {
    progress_.warn(file_.string() +
                   ": damaged checkpoint: its blocks have other sizes; the frame is rendered "
                   "from the beginning");
  }
  found_.reset();
  return fits;
}

}  // namespace pelage
