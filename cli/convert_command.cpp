// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "cli/commands.h"
#include "geom/io/strand_file.h"

namespace pelage {

int run_convert(const Options& options) {
  const StrandFile file = read_strands(options.input, {options.basis, options.default_width});
  write_strands(options.output, file.strands);
  std::cout << options.output << ": " << file.strands.strand_count() << " strands";
  if (file.repairs.repaired > 0) std::cout << ", " << file.repairs.repaired << " repaired";
  if (file.repairs.dropped > 0) std::cout << ", " << file.repairs.dropped << " dropped";
  std::cout << "\n";
  return 0;
}

}  // namespace pelage
