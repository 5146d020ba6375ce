// SPDX-License-Identifier: Apache-2.0
#include "cli/guide_output.h"

#include <iostream>

#include <fmt/format.h>

#include "base/counted.h"
#include "base/nearest_name.h"
#include "cli/output_files.h"
#include "geom/io/strand_file.h"
#include "groom/operators/follow.h"
#include "world/guide_poses.h"
#include "world/motion_files.h"

namespace pelage {

void check_guide_output(const Options& options, const SceneDescription& scene) {
  if (!options.groom.empty() && !scene.grooms.find(options.groom)) {
    throw Error(ErrorKind::kArguments, "there is no groom '" + options.groom + "'" +
                                           did_you_mean(options.groom, scene.grooms.names()));
  }
  if (options.output.empty()) return;
  if (!is_strand_file(options.output))
    throw Error(ErrorKind::kArguments, "-o " + options.output + ": guides are written as " + kStrandEndings);
  check_output_pattern(options.output, scene.frames);
  check_stats(options, {options.output});
  for (const int frame : scene.frames.frames) {
    const std::string file = frame_file_name(options.output, frame);
    check_replaces_none("-o", file, scene.files);
    check_replaces_none("-o", file, motion_files(scene, {&frame, 1}));
  }
  prepare_output(frame_file_name(options.output, scene.frames.frames.front()));
}

const MovingCoat& coat_to_write(const Options& options, const std::vector<MovingCoat>& coats) {
  const std::string suffix = "." + options.groom;
  std::vector<const MovingCoat*> found;
  std::string names;
  for (const MovingCoat& coat : coats) {
    if (!options.groom.empty() && coat.name != coat.character.name + suffix) continue;
    found.push_back(&coat);
    names += (names.empty() ? "" : ", ") + coat.name;
  }
  if (found.size() == 1) {
    if (!found.front()->groom->guides()->follicles.empty()) return *found.front();
    throw Error(ErrorKind::kInput, "-o " + options.output + ": coat '" + names + "' has no strands");
  }
  if (found.empty()) {
    throw Error(ErrorKind::kArguments,
                "-o " + options.output + ": " +
                    (options.groom.empty() ? "no groom of a character has `dynamics`, so no coat has guides"
                                           : "groom " + quote(options.groom) +
                                                 " has no guides: no character has it with `dynamics`"));
  }
  throw Error(ErrorKind::kArguments,
              "-o " + options.output + ": a file holds the guides of one coat, but there are " + names +
                  (options.groom.empty() ? "; choose one groom with --groom"
                                         : "; give each character a groom of its own"));
}

void write_guides(const Options& options, const SceneDescription& scene, const Assets& assets,
                  const MovingCoat& coat, Run& run) {
  const std::vector<int>& frames = scene.frames.frames;
  for (const int frame : frames) {
    run.job().check_stop();
    const GuideTurns turns =
        options.as_groomed ? GuideTurns() : guide_turns(scene, assets, coat, frame, run.job());
    write_strands(frame_file_name(options.output, frame),
                  guide_strands(assets, coat, frame, turns, run.job()), false);
  }
  std::cout << fmt::format("{}: {} guides{} of {} written to {}\n", coat.name,
                           coat.groom->guides()->follicles.size(), options.as_groomed ? " as groomed" : "",
                           counted(static_cast<int64_t>(frames.size()), "frame"), options.output);
}

}  // namespace pelage
