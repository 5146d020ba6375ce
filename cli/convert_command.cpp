// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "cli/commands.h"
#include "geom/io/strand_file.h"

namespace pelage {

int run_convert(const Options& options) {
  if (!is_strand_file(options.output)) {
    throw Error(ErrorKind::kArguments, options.output + ": strands are written as .hair or .tfx");
  }
  const StrandFile file = read_strands(options.input, {options.basis, options.default_width});
  write_strands(options.output, file.strands);
  std::cout << options.output << ": " << file.strands.strand_count() << " strands";
  if (file.repairs.repaired > 0) std::cout << ", " << file.repairs.repaired << " repaired";
  if (file.repairs.dropped > 0) std::cout << ", " << file.repairs.dropped << " dropped";
  std::cout << "\n";
  return 0;
}

}  // namespace pelage
