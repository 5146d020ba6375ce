// SPDX-License-Identifier: Apache-2.0
#include "cli/read_scene.h"

#include "groom/operators/operator_scripts.h"

namespace pelage {

SceneDescription read_scene(const RunOptions& options, Progress& progress) {
  return read_scene(options, progress, rib_use(options.rib_in));
}

SceneDescription read_scene(const RunOptions& options, Progress& progress, const RibUse& use) {
  SceneDescription scene = load_scene(options.input, options.overrides, use);
  for (const Problem& warning : scene.warnings)
    progress.warn(to_string(warning.position) + ": " + warning.message);
  scene.growth_cache = growth_cache(options);
  if (options.allow_scripts) scene.scripts = python_scripts();
  return scene;
}

}  // namespace pelage
