// SPDX-License-Identifier: Apache-2.0
#include "cli/rib_flags.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "rib/scene/rib_programs.h"

namespace pelage {

void add_rib_use_flags(CLI::App& command, RibUseOptions& options) {
  command
      .add_option("--materials", options.materials,
                  "YAML file that maps the shaders of RIB files to materials (docs/RIB.md)")
      ->type_name("FILE.yaml");
  command.add_flag("--allow-procedurals", options.allow_procedurals,
                   "Run the programs that RIB files name (RunProgram)");
}

RibUse rib_use(const RibUseOptions& options) {
  RibUse use;
  use.materials = options.materials;
  if (options.allow_procedurals) use.programs = std::make_shared<RibPrograms>();
  return use;
}

void add_rib_flags(CLI::App& rib, RibOptions& options) {
  rib.add_flag("--ascii", options.ascii, "Write text instead of the binary encoding");
  CLI::Option* archives =
      rib.add_flag("--archives", options.archives, "Write one archive per leaf of a coat, read on demand");
  CLI::Option* expand =
      rib.add_flag("--expand", options.expand, "Write all strands as Curves")->excludes(archives);
  rib.add_flag("--lod", options.lod,
               "With --archives or --expand: write only the strands that remain at the picture's level of "
               "detail (render.lod)");
  archives->excludes(expand);
}

void add_procedural_flags(CLI::App& procedural, RibOptions& options) {
  procedural
      .add_option("--command", options.command,
                  "Command of nested procedurals in the replies (default: pelage procedural)")
      ->type_name("COMMAND");
}

}  // namespace pelage
