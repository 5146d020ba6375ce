// SPDX-License-Identifier: Apache-2.0
#include "cli/read_scene.h"

namespace pelage {

SceneDescription read_scene(const Options& options, Progress& progress) {
  SceneDescription scene = load_scene(options.input, options.overrides);
  for (const Problem& warning : scene.warnings)
    progress.warn(to_string(warning.position) + ": " + warning.message);
  return scene;
}

}  // namespace pelage
