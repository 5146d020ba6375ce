// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "base/counted.h"
#include "base/file.h"
#include "cli/commands.h"
#include "cli/output_files.h"
#include "cli/run.h"
#include "post/band_job.h"
#include "post/blur_file.h"
#include "post/stereo_file.h"
#include "world/frames.h"

namespace pelage {
namespace {

/// Processes one picture: reads the file `input` and writes the file `output`.
using PostWork = std::function<PostReport(const std::string& input, const std::string& output, Run& run)>;

void check_names(const Options& options, const FrameList& frames) {
  if (lower_extension(options.output) != ".exr") {
    throw Error(ErrorKind::kArguments, "-o " + options.output + ": pictures are written as .exr");
  }
  if (options.frames.empty()) {
    if (has_frame_pattern(options.input)) {
      throw Error(ErrorKind::kArguments, options.input + ": give the frames with --frames");
    }
    return;
  }
  check_output_pattern(options.output, frames);
  if (frames.frames.size() > 1 && !has_frame_pattern(options.input)) {
    throw Error(ErrorKind::kArguments,
                options.input + ": the file name of several frames needs a frame number, as in %04d");
  }
}

/// Watches a sequence for motion vectors that are missing: all are zero, although the depths change.
class VectorCheck {
 public:
  void add(const PostReport& report) {
    moves_ |= report.longest > 0;
    changes_ |= first_ && *first_ != report.depth_hash;
    if (!first_) first_ = report.depth_hash;
  }
  bool suspects() const { return changes_ && !moves_; }

 private:
  std::optional<uint64_t> first_;
  bool moves_ = false, changes_ = false;
};

/// Calls `work` for every frame of `--frames`, with the frame number inserted in the names of input and
/// output. Without `--frames`, calls `work` once, with the names as they were given. Prints a line about each
/// file that was written. Returns the exit code of the process. Throws Error (kArguments) when the names do
/// not fit the frames or the output is not an .exr file. Passes on exceptions of `work`.
int run_post_frames(const Options& options, const PostWork& work) {
  const FrameList frames = options.frames.empty() ? FrameList() : parse_frames(options.frames);
  check_names(options, frames);
  Run run(options);
  const auto name_of = [&](const std::string& pattern, int frame) {
    return options.frames.empty() ? pattern : frame_file_name(pattern, frame);
  };
  for (const int frame : frames.frames)
    check_stats(options, {name_of(options.input, frame), name_of(options.output, frame)});
  prepare_output(name_of(options.output, frames.frames.front()));
  VectorCheck vectors;
  for (size_t i = 0; i < frames.frames.size(); ++i) {
    const int frame = frames.frames[i];
    run.display().frame(frame, i + 1, frames.frames.size());
    const std::string input = name_of(options.input, frame), output = name_of(options.output, frame);
    const double began = run.seconds();
    const PostReport report = work(input, output, run);
    for (const std::string& warning : report.warnings) {
      run.display().warn(fmt::format("{}: {}", input, warning));
    }
    for (const std::string& note : report.notes) run.display().note(fmt::format("{}: {}", input, note));
    if (report.cancelled) return SignalGuard::exit_code();
    vectors.add(report);
    run.statistics().stages_s["post"] += run.seconds() - began;
    run.display().note(fmt::format("{}  {} x {}, up to {:.1f} pixels, {}, {}", output, report.window.width(),
                                   report.window.height(), report.longest, counted(report.steps, "step"),
                                   duration_text(run.seconds() - began)));
  }
  if (vectors.suspects())
    run.display().warn(options.input +
                       ": all motion vectors of all frames are zero, although the depths change: nothing is "
                       "blurred; render the frames again with motion vectors");
  run.finish(options);
  return 0;
}

}  // namespace

int run_motion_blur(const Options& options) {
  return run_post_frames(options, [&](const std::string& input, const std::string& output, Run& run) {
    return blur_file(input, output, options.motion_blur, run.job());
  });
}

int run_stereo(const Options& options) {
  return run_post_frames(options, [&](const std::string& input, const std::string& output, Run& run) {
    return stereo_file(input, output, options.stereo, run.job());
  });
}

}  // namespace pelage
