// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "base/progress.h"
#include "base/stopwatch.h"
#include "image/exr.h"
#include "world/checkpoint_file.h"
#include "world/scene_schema.h"

namespace pelage {

/// Returns what determines the pixels of the scene's frames, except the poses of one frame: the parts of the
/// scene, the contents of the files that it names, the program and the instructions of the processor. Ignores
/// `frames` and `render.memory`, which change no pixel. Reads all these files; throws Error (kInput) when one
/// cannot be read.
FrameInputs frame_inputs(const SceneDescription& scene);

/// Adds the frame, and the region if there is one.
FrameInputs frame_inputs(const FrameInputs& scene, int frame, const std::optional<PixelBox>& region);

/// Returns the name of the checkpoint file of a frame: "frame-0007.checkpoint" or, for a region,
/// "frame-0007-0-0-160-90.checkpoint".
std::string checkpoint_name(int frame, const std::optional<PixelBox>& region);

/// The checkpoint of one frame: a file that holds the state of its film, or that says that the frame is
/// finished. A render saves its state there from time to time, and a later render of the same frame continues
/// from it (FrameSaver). A file that cannot be written is reported as a warning, and the previous one stays.
class Checkpoint final : public FrameSaver {
 public:
  /// When the state is saved.
  struct Schedule {
    double every_s = 60;
    /// Returns how many times the user has asked for a checkpoint so far. Any thread calls it. May be empty.
    std::function<uint32_t()> requests = {};
  };
  /// `inputs`: see frame_inputs().
  Checkpoint(std::filesystem::path file, FrameInputs inputs, Schedule schedule, Progress& progress);

  enum class Found {
    kNothing,  ///< no checkpoint, or a damaged one (a warning names it)
    kState,    ///< a state to continue from
    kPicture,  ///< the frame is finished
  };
  /// Looks for an earlier checkpoint and remembers it for restore(). `picture`: the file that the frame is
  /// written to; a frame counts as finished only while this file has the contents with which it was finished.
  /// Throws Error (kInput) when the checkpoint belongs to another render, and names what differs, or when the
  /// folder does not show whether there is one.
  Found find(const std::filesystem::path& picture);
  /// Call before the frame is rendered. `poses`: World::poses. Throws the same error if the checkpoint has
  /// other poses.
  void begin(const ContentHash& poses);

  /// Records that the frame is finished and written to `picture`. Replaces the stored state.
  void finish(const std::filesystem::path& picture);

  /// Duration of the render in earlier runs, in seconds; 0 if it does not continue.
  double earlier_s() const { return earlier_s_; }
  const std::filesystem::path& file() const { return file_; }

  bool due() const override;
  void save(const FrameState& state) override;
  bool restore(const FrameState& state) override;

 private:
  using Clock = std::chrono::steady_clock;
  void compare(const FrameInputs& before) const;
  void set_next();
  CheckpointRecord record() const;

  std::filesystem::path file_;
  FrameInputs inputs_;
  Schedule schedule_;
  Progress& progress_;
  Stopwatch clock_;
  std::optional<CheckpointFile> found_;
  double earlier_s_ = 0;
  std::atomic<Clock::rep> next_{0};  // when the state is due
  std::atomic<uint32_t> requests_seen_{0};
};

}  // namespace pelage
