// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <fmt/format.h>

#include "base/counted.h"
#include "base/file.h"
#include "cli/commands.h"
#include "cli/output_files.h"
#include "cli/run.h"
#include "post/merge_pieces.h"
#include "post/piece_headers.h"

namespace pelage {

int run_merge(const Options& options) {
  Run run(options);
  if (lower_extension(options.output) != ".exr")
    throw Error(ErrorKind::kArguments, "-o " + options.output + ": merged pictures are written as .exr");
  const std::vector<std::filesystem::path> pieces(options.pieces.begin(), options.pieces.end());
  check_replaces_none("-o", options.output, pieces);
  if (is_merged(pieces, options.output, options.merge.any_instructions)) {
    run.display().note(options.output + "  is finished, skipped");
    return 0;
  }
  prepare_output(options.output);
  const PixelBox frame = merge_pieces(pieces, options.output, options.merge, run.job());
  if (frame.width() == 0) return SignalGuard::exit_code();
  run.display().note(fmt::format("{}  {} x {}, {}", options.output, frame.width(), frame.height(),
                                 counted(static_cast<int64_t>(pieces.size()), "piece")));
  return 0;
}

}  // namespace pelage
