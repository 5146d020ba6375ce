// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>
#include <map>

#include <fmt/format.h>

#include "base/counted.h"
#include "base/nearest_name.h"
#include "cli/commands.h"
#include "cli/guide_output.h"
#include "cli/read_scene.h"
#include "cli/run.h"
#include "groom/operators/follow.h"
#include "world/coat_simulation.h"

namespace pelage {
namespace {

/// Range of frames whose motion the pictures of the scene need.
std::pair<int, int> wanted_frames(const SceneDescription& scene) {
  const auto [first, last] = std::minmax_element(scene.frames.frames.begin(), scene.frames.frames.end());
  return {frames_of_motion(scene.camera, *first).first, frames_of_motion(scene.camera, *last).second};
}

void explain_coat(const MovingCoat& coat, const std::vector<MotionChange>& changes) {
  for (const auto& [name, value] : coat.inputs) {
    const auto change =
        std::find_if(changes.begin(), changes.end(), [&](const auto& c) { return c.name == name; });
    std::cout << fmt::format("  {:<18} {}{}\n", name, value,
                             change == changes.end() ? "" : "  (stale: was " + change->before + ")");
  }
}

void report_motion(const MovingCoat& coat, const SimulationReport& done, Progress& progress) {
  const size_t guides = coat.groom->guides()->follicles.size();
  std::cout << fmt::format("{}: {} simulated", coat.name, counted(done.simulated, "frame"));
  if (done.simulated > 0) {
    std::cout << fmt::format(" from frame {}, {} guides, {:.1f} ms per frame", done.begun, guides,
                             1000 * done.seconds / done.simulated);
  }
  if (done.found > 0)
    std::cout << fmt::format(", {} found in {}", done.found, coat.store.store().folder().string());
  std::cout << "\n";
  if (done.most_rigid > 0) {
    progress.warn(
        fmt::format("{}: up to {} of {} guides could not be simulated in {} and followed their skin "
                    "rigidly; strands of no length have no motion, others may need more `substeps`",
                    coat.name, done.most_rigid, guides, counted(done.rigid_frames, "frame")));
  }
}

/// Deletes the motion that no frame up to `last` needs.
void prune_motion(const std::vector<MovingCoat>& coats, int last) {
  std::map<std::filesystem::path, std::vector<std::filesystem::path>> folders;
  for (const MovingCoat& coat : coats) {
    if (!coat.params->is_simulated()) continue;
    std::vector<std::filesystem::path>& keep = folders[coat.store.store().folder()];
    keep.push_back(manifest_file(coat));
    for (int frame = coat.start + 1; frame <= last; ++frame) keep.push_back(coat.store.file(frame));
  }
  for (const auto& [folder, keep] : folders) {
    const ContentStore::Removed removed = ContentStore(folder).prune(std::chrono::hours(1), keep);
    std::cout << fmt::format("{}: {} removed, {:.1f} MiB\n", folder.string(),
                             counted(static_cast<int64_t>(removed.files), "file"),
                             static_cast<double>(removed.bytes) / (1 << 20));
  }
}

/// Simulates the coats of a scene, or only those of the groom that `--groom` names.
void simulate_coats(const Options& options, const SceneDescription& scene, const Assets& assets,
                    const std::vector<MovingCoat>& coats, Run& run) {
  const auto [first, last] = wanted_frames(scene);
  bool some = false;
  std::string instead;
  for (const MovingCoat& coat : coats) {
    if (!options.groom.empty() && coat.name != coat.character.name + "." + options.groom) continue;
    if (!coat.params->is_simulated()) {
      const AssetPath& files = coat.params->files;
      instead += fmt::format("{}{}: {}", instead.empty() ? "" : "; ", coat.name,
                             files.empty() ? "`mode: kinematic`" : "guides from " + files.path.string());
      continue;
    }
    some = true;
    const std::vector<MotionChange> changes = changed_inputs(coat);
    if (options.explain) explain_coat(coat, changes);
    run.display().begin("simulate " + coat.name, std::max(1, last - std::max(first, coat.start + 1) + 1));
    const SimulationReport done =
        simulate(scene, assets, coat, first, last, run.job(), [&](int) { run.display().advance(1); });
    run.display().end();
    store_inputs(coat);
    run.statistics().stages_s["simulate"] += done.seconds;
    report_motion(coat, done, run.display());
  }
  if (!instead.empty() && (some || !options.output.empty()))
    std::cout << "not simulated: " << instead << "\n";
  if (some || (!options.output.empty() && !instead.empty())) return;
  throw Error(ErrorKind::kArguments,
              scene.files.front().string() + ": " +
                  (!instead.empty()        ? "nothing to simulate (" + instead + ")"
                   : options.groom.empty() ? "no groom of a character has `dynamics` that is simulated"
                                           : "no character has the groom " + quote(options.groom) +
                                                 " with `dynamics` that is simulated"));
}

}  // namespace

int run_simulate(const Options& options) {
  Run run(options);
  const SceneDescription scene = read_scene(options, run.display());
  check_guide_output(options, scene);
  const auto assets = run.stage("read", [&] { return load_assets(scene, run.job()); });
  const std::vector<MovingCoat> coats = moving_coats(scene, *assets);
  const MovingCoat* written = options.output.empty() ? nullptr : &coat_to_write(options, coats);
  if (!options.as_groomed) simulate_coats(options, scene, *assets, coats, run);
  if (written) write_guides(options, scene, *assets, *written, run);
  if (options.prune) prune_motion(coats, wanted_frames(scene).second);
  run.finish(options);
  return 0;
}

}  // namespace pelage
