// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "cli/commands.h"
#include "cli/output_files.h"
#include "cli/progress_display.h"
#include "geom/io/alembic_strands.h"
#include "geom/io/mesh_file.h"
#include "geom/io/strand_file.h"

namespace pelage {

int run_convert(const Options& options) {
  if (!is_strand_file(options.output)) {
    throw Error(ErrorKind::kArguments, options.output + ": strands are written as " + kStrandEndings);
  }
  if (options.host != AlembicHost::kAny && !is_alembic_file(options.output))
    throw Error(ErrorKind::kArguments, "--for needs an .abc file to write");
  const StrandFile file =
      read_strands(options.input, {options.basis, options.default_width, true, options.memory});
  ProgressDisplay display(options.progress, [] { return false; });
  for (const std::string& warning : file.warnings) display.warn(warning);
  // Widths that neither the file nor the user states stay unstated.
  const bool has_widths = file.assumed_width == 0;
  if (options.host != AlembicHost::kAny) {
    const AlembicCurvesFacts facts = alembic_facts(options.output, has_widths, options.host);
    for (const std::string& name : lost_alembic_attributes(file.strands, facts))
      display.warn(options.output + ": this .abc file cannot hold the attribute " + name);
    write_alembic_strands(options.output, file.strands, facts);
  } else {
    warn_of_losses(options.output, file.strands, display);
    write_strands(options.output, file.strands, has_widths);
  }
  std::cout << options.output << ": " << file.strands.strand_count() << " strands";
  if (!has_widths) std::cout << " without widths";
  if (file.repairs.repaired > 0) std::cout << ", " << file.repairs.repaired << " repaired";
  if (file.repairs.dropped > 0) std::cout << ", " << file.repairs.dropped << " dropped";
  std::cout << "\n";
  return 0;
}

}  // namespace pelage
