// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/output_files.h"
#include "cli/read_scene.h"
#include "cli/run.h"
#include "rib/host/scene_rib.h"

namespace pelage {
namespace {

void check_arguments(const Options& options) {
  const std::string name = options.output;
  if (!name.ends_with(".rib") && !name.ends_with(".rib.gz"))
    throw Error(ErrorKind::kArguments, "-o " + name + ": RIB files are named .rib or .rib.gz");
  if (options.rib.lod && !options.rib.archives && !options.rib.expand)
    throw Error(ErrorKind::kArguments, "--lod needs --archives or --expand; procedurals follow render.lod");
}

}  // namespace

int run_rib(const Options& options) {
  Run run(options);
  check_arguments(options);
  SceneDescription scene = read_scene(options, run.display());
  SceneRibOptions rib;
  rib.format = {options.rib.ascii ? RibEncoding::kAscii : RibEncoding::kBinary,
                options.output.ends_with(".gz")};
  rib.lod = options.rib.lod;
  rib.coats = options.rib.archives ? RibCoats::kArchives
              : options.rib.expand ? RibCoats::kExpanded
                                   : RibCoats::kProcedurals;
  if (rib.coats != RibCoats::kProcedurals && !rib.lod) scene.render.lod.enabled = false;
  check_stats(options, scene.files);
  check_replaces_none("-o", options.output, scene.files);
  prepare_output(options.output);
  const auto assets = run.stage("read", [&] { return load_assets(scene, run.job()); });
  const SceneRibSource source{options.input, options.overrides, scene, *assets};
  for (const std::filesystem::path& path : write_scene_rib(options.output, source, rib, run.job()))
    run.display().note(path.string());
  run.finish(options);
  return 0;
}

}  // namespace pelage
