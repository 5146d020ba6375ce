// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <fmt/format.h>

#include "base/counted.h"
#include "base/file.h"
#include "base/heap.h"
#include "cli/commands.h"
#include "cli/frame_checkpoints.h"
#include "cli/output_files.h"
#include "cli/picture_flags.h"
#include "cli/progress_display.h"
#include "cli/render_estimate.h"
#include "cli/run.h"
#include "image/display_image.h"
#include "image/exr_file.h"
#include "world/dark_lights.h"
#include "world/world.h"

namespace pelage {

namespace {

std::string output_name(const Options& options, const FrameList& frames) {
  if (!options.output.empty()) return options.output;
  const std::string stem = std::filesystem::path(options.input).stem().string();
  return frames.frames.size() > 1 ? stem + ".%04d.exr" : stem + ".exr";
}

// No output may replace another file, and an hour of rendering must not end with "permission denied".
void check_files(const Options& options, const SceneDescription& scene, const std::string& output) {
  check_stats(options, scene.files);
  for (const int frame : scene.frames.frames) {
    const std::string picture = frame_file_name(output, frame);
    check_stats(options, {picture});
    check_replaces_none("-o", picture, scene.files);
  }
  prepare_output(frame_file_name(output, scene.frames.frames.front()));
  if (options.stats) prepare_output(*options.stats);
}

// "64 samples" of every pixel; "37.5 samples on average".
std::string samples_text(const FrameResult& result) {
  if (result.mean_samples == result.samples) return counted(result.samples, "sample");
  return fmt::format("{:.1f} samples on average", result.mean_samples);
}

void note_no_output(const std::string& path, Run& run) {
  run.display().warn(path + ": stopped before the first sample; nothing was written");
}

// Path for a picture. An interrupted PNG or JPEG, which cannot state that it is partial, has another name. An
// EXR with pixels that have no sample does not replace an existing file but is written beside it.
std::string place_of(const FrameResult& result, const std::string& path) {
  std::error_code ignored;
  const bool moves =
      is_display_image(path) ? result.partial : result.samples == 0 && std::filesystem::exists(path, ignored);
  if (!moves) return path;
  const std::filesystem::path named(path);
  return std::filesystem::path(named).replace_extension(".partial" + named.extension().string()).string();
}

// Whether a PNG or JPEG file ends as such a file must.
bool has_end(const std::string& path) {
  try {
    const std::string bytes = read_file(path);
    return bytes.ends_with(std::string_view("IEND\xae\x42\x60\x82")) || bytes.ends_with("\xff\xd9");
  } catch (const Error&) {
    return false;
  }
}

// Whether a file holds a complete picture: it exists, and its header does not say that it is partial. An EXR
// file that cannot be read is not complete. A PNG or JPEG with its own name is complete if its end is there,
// see place_of().
bool is_complete(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return false;
  if (is_display_image(path)) return has_end(path);
  try {
    const ExrAttributes attributes = ExrReader(path).parts().front().attributes;
    const auto partial = attributes.find("pelage:partial");
    const int* flag = partial == attributes.end() ? nullptr : std::get_if<int>(&partial->second);
    return !flag || *flag == 0;
  } catch (const Error&) {
    return false;
  }
}

// The frames to render, without those that --skip-existing skips.
std::vector<int> missing_frames(const Options& options, const FrameList& list, const std::string& output,
                                Run& run) {
  std::vector<int> missing;
  for (const int frame : list.frames) {
    const std::string path = frame_file_name(output, frame);
    if (options.picture.skip_existing && is_complete(path)) {
      run.display().note(path + "  exists, skipped");
    } else {
      missing.push_back(frame);
    }
  }
  return missing;
}

// Why a whole picture is black, if it is; empty if the scene has no light, which was said before.
std::string why_black(const SceneDescription& scene, const FrameResult& result) {
  bool sees = false;
  for (int y = 0; y < result.film.height(); ++y) {
    for (int x = 0; x < result.film.width(); ++x) {
      if (max_component(result.film.radiance(x, y)) > 0) return {};
      sees |= result.film.alpha(x, y) > 0;
    }
  }
  if (!sees) return "the picture is empty: no camera ray hits a strand or a skin";
  if (why_dark(scene)) return {};
  return "the picture is black: no light reaches what the camera sees, because surfaces block it or are "
         "black";
}

// Renders and writes one frame; returns whether it is complete. `checkpoint`: may be null.
bool render_one(const SceneDescription& scene, Assets& assets, int frame, const std::string& path,
                FrameOptions how, Checkpoint* checkpoint, Run& run) {
  const double began = run.seconds();
  const World world = run.stage("pose", [&] { return compose(scene, assets, frame, run.job()); });
  run.statistics().world += world.counts;
  const double posed = run.seconds();
  if (checkpoint) checkpoint->begin(world.poses);
  how.saver = checkpoint;
  const FrameResult result = render(world, run.job(), how);
  run.statistics().add(result, posed, 1.0 / static_cast<double>(scene.frames.frames.size()));
  if (result.mean_samples == 0) {
    note_no_output(path, run);
    return false;
  }
  if (result.partial && checkpoint && SignalGuard::from_outside()) {
    run.display().note(checkpoint->file().string() + "  holds " + samples_text(result));
    return false;
  }
  if (const std::string why = how.region || result.partial ? "" : why_black(scene, result); !why.empty())
    run.display().warn(path + ": " + why);
  const double seconds = run.seconds() - began + (checkpoint ? checkpoint->earlier_s() : 0);
  trim_heap();  // the chunks of the frame are gone
  const std::string place = place_of(result, path);
  if (std::error_code ignored; place != path && std::filesystem::exists(path, ignored))
    run.display().warn(path + ": kept, because the new picture is partial");
  run.stage("write", [&] { write_frame(place, world, result, seconds, run.job()); });
  if (checkpoint && !result.partial) checkpoint->finish(place);
  const std::string clamped =
      scene.render.clamp_indirect > 0
          ? fmt::format(", {:.2g} % of the indirect light clamped", 100 * result.clamped_fraction)
          : "";
  run.display().note(fmt::format("{}  {} x {}, {}{}{}, {}", place, result.window.region.width(),
                                 result.window.region.height(), samples_text(result),
                                 result.partial ? " (partial)" : "", clamped, duration_text(seconds)));
  return !result.partial;
}

}  // namespace

int run_render(const Options& options) {
  Run run(options);
  SceneDescription scene = read_picture_scene(options, run.display());
  const std::string output = output_name(options, scene.frames);
  if (lower_extension(output) != ".exr" && !is_display_image(output)) {
    throw Error(ErrorKind::kArguments, "-o " + output + ": pictures are written as .exr, .png or .jpg");
  }
  if (options.picture.estimate) return print_estimate(scene, options, run);
  check_output_pattern(output, scene.frames);
  check_files(options, scene, output);

  FrameCheckpoints checkpoints(options, scene, run.display());
  scene.frames.frames = missing_frames(options, scene.frames, output, run);
  scene.frames.frames =
      checkpoints.unfinished(scene.frames.frames, [&](int frame) { return frame_file_name(output, frame); });
  if (scene.frames.frames.empty()) {  // the statistics of the run that rendered them remain
    if (std::error_code none; options.stats && !std::filesystem::exists(*options.stats, none))
      run.finish(options);
    return 0;
  }
  keep_spare_heap(scene.render.memory.bytes, run.job().workers.thread_count());
  FrameOptions how;
  how.region = options.picture.region;

  bool complete = true;
  std::string path = frame_file_name(output, scene.frames.frames.front());
  try {
    MemoryCharge film = reserve_film(scene, run.job(), how.region);
    const auto assets = run.stage("read", [&] { return load_assets(scene, run.job()); });
    for (const auto& [name, groom] : assets->grooms) run.statistics().repairs += groom->repairs();
    film = {};  // each frame makes its own
    for (size_t i = 0; i < scene.frames.frames.size() && complete; ++i) {
      path = frame_file_name(output, scene.frames.frames[i]);
      run.display().frame(scene.frames.frames[i], i + 1, scene.frames.frames.size());
      const int frame = scene.frames.frames[i];
      complete = render_one(scene, *assets, frame, path, how, checkpoints.of(frame), run);
    }
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kStopped) throw;
    note_no_output(path, run);
    complete = false;
  }
  run.finish(options);
  return complete ? 0 : SignalGuard::exit_code();
}

}  // namespace pelage
