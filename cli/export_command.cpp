// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include "cli/commands.h"
#include "cli/output_files.h"
#include "cli/read_scene.h"
#include "cli/run.h"
#include "exchange/scene_export.h"

namespace pelage {

int run_export(const Options& options) {
  Run run(options);
  SceneDescription scene = read_scene(options, run.display());
  scene.render.lod.enabled = false;
  check_stats(options, scene.files);
  const std::filesystem::path folder = options.output;
  if (std::filesystem::exists(folder) && !std::filesystem::is_directory(folder))
    throw Error(ErrorKind::kArguments, "-o " + options.output + ": is a file; name a folder");
  const auto assets = run.stage("read", [&] { return load_assets(scene, run.job()); });
  for (const auto& file :
       export_scene(folder, options.export_format, {options.input, scene, *assets}, run.job()))
    run.display().note(file.string());
  run.display().note((folder / "README.md").string());
  run.finish(options);
  return 0;
}

}  // namespace pelage
