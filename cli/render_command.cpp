// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "base/file.h"
#include "base/heap.h"
#include "base/memory_budget.h"
#include "cli/commands.h"
#include "cli/compose.h"
#include "cli/counted.h"
#include "cli/progress_display.h"
#include "cli/run.h"
#include "cli/version.h"
#include "render/film/frame_header.h"
#include "render/path/frame_layers.h"
#include "render/path/path_integrator.h"

namespace pelage {

namespace {

std::string output_name(const Options& options, const FrameList& frames) {
  if (!options.output.empty()) return options.output;
  const std::string stem = std::filesystem::path(options.input).stem().string();
  return frames.frames.size() > 1 ? stem + ".%04d.exr" : stem + ".exr";
}

// An hour of rendering must not end with "permission denied".
void check_writable(const std::string& path) { const AtomicFile probe(path); }

// "64 samples" of every pixel; "37.5 samples on average".
std::string samples_text(const FrameResult& result) {
  if (result.mean_samples == result.samples) return counted(result.samples, "sample");
  return fmt::format("{:.1f} samples on average", result.mean_samples);
}

// The picture's film is as large as the scene says: what comes before it must leave room for it.
MemoryCharge reserve_film(const SceneDescription& scene, MemoryLedger& ledger) {
  std::vector<FilmLayers::LightInfo> lights;
  for (const auto& [name, position, light] : scene.lights.items)
    lights.push_back({name, std::visit([](const auto& params) { return params.visible; }, light)});
  std::vector<MaterialParams> materials;
  for (const auto& material : scene.materials.items) materials.push_back(material.value);
  const FilmLayers layers = frame_layers(scene.image, scene.render, lights, materials);
  return reserve(ledger, MemoryTag::kFilm, Film::bytes_needed(scene.image.width, scene.image.height, layers),
                 fmt::format("the film of {} x {} pixels", scene.image.width, scene.image.height));
}

// Renders and writes one frame; returns whether all of it was done.
bool render_one(const SceneDescription& scene, Assets& assets, int frame, const std::string& path, Run& run) {
  const double began = run.seconds();
  World world = run.stage("pose", [&] { return compose(scene, assets, frame, run.job()); });
  run.statistics().strands_described += world.strands_described;
  run.statistics().strands_unique += world.strands_unique;
  run.statistics().characters += world.characters;
  run.statistics().characters_in_frame += world.characters_in_frame;
  const double posed = run.seconds();
  const FrameResult result =
      render_frame(world.scene, run.workers(), run.display(), run.ledger(), run.statistics());

  if (run.statistics().first_pixel_s == 0) {
    run.statistics().first_pixel_s = posed + result.first_tile_s;
  }
  run.statistics().samples_per_pixel += result.mean_samples / static_cast<double>(scene.frames.frames.size());
  run.statistics().noise = std::max(run.statistics().noise, result.noise);
  run.statistics().time_limited |= result.time_limited;
  const double seconds = run.seconds() - began;
  FrameHeader header;
  header.frame = frame;
  header.frames_per_second = scene.units.fps;
  header.meters_per_unit = scene.units.meters_per_unit;
  header.seed = scene.render.seed;
  header.samples = result.samples;
  header.mean_samples = result.mean_samples;
  if (scene.render.adaptive)
    header.adaptive = EnumNames<AdaptiveRule>::names[static_cast<int>(scene.render.adaptive->rule)];
  header.time_limited = result.time_limited;
  header.partial = result.partial;
  header.render_seconds = seconds;
  header.peak_memory_bytes = peak_rss_bytes();
  header.program_version = version();
  header.scene_hash = scene.hash;
  give_back_heap();  // the chunks of the frame are gone
  const Film& film = result.film;
  run.stage("write", [&] {
    write_exr(
        path, film.width(), film.height(), exr_attributes(header, world.scene.camera),
        [&film](int y0, int y1) { return film.exr_rows(y0, y1); }, run.workers(), run.ledger());
  });
  run.display().note(fmt::format("{}  {} x {}, {}{}, {}", path, scene.image.width, scene.image.height,
                                 samples_text(result), result.partial ? " (partial)" : "",
                                 duration_text(seconds)));
  return !result.partial;
}

}  // namespace

int run_render(const Options& options) {
  Run run(options);
  const SceneDescription scene = load_scene(options.input, options.overrides);
  run.ledger().set_limit(scene.render.memory.bytes);
  const std::string output = output_name(options, scene.frames);
  if (std::filesystem::path(output).extension() != ".exr") {
    throw Error(ErrorKind::kArguments, "-o " + output + ": pictures are written as .exr");
  }
  check_output_pattern(output, scene.frames);
  check_writable(frame_file_name(output, scene.frames.frames.front()));

  MemoryCharge film = reserve_film(scene, run.ledger());
  const auto assets = run.stage("read", [&] { return load_assets(scene, run.job()); });
  for (const auto& [name, groom] : assets->grooms) {
    run.statistics().strands_dropped += groom->strands_dropped();
    run.statistics().strands_repaired += groom->strands_repaired();
  }
  film = {};  // each frame makes its own
  bool complete = true;
  for (int frame : scene.frames.frames) {
    complete = render_one(scene, *assets, frame, frame_file_name(output, frame), run);
    if (!complete) break;
  }
  run.finish(options);
  return complete ? 0 : kInterruptedExitCode;
}

}  // namespace pelage
