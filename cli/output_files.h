// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.h"
#include "cli/run_options.h"
#include "geom/strands.h"

namespace pelage {

/// Throws Error (kArguments) when writing to `output` would replace one of the files in `kept`. Also detects
/// files that are reached by different paths. `flag` is the flag that gave `output`, for the message.
void check_replaces_none(const std::string& flag, const std::filesystem::path& output,
                         const std::vector<std::filesystem::path>& kept);

/// Makes the same check for the file of `--stats`, if this flag is given.
void check_stats(const RunOptions& options, const std::vector<std::filesystem::path>& kept);

/// Checks that `path` can be written; call it before long work. Throws Error (kFailed) when it cannot. Also
/// removes temporary files that killed runs left in the same folder.
void prepare_output(const std::filesystem::path& path);

/// Warns, in one line, of everything that a strand file of this name cannot hold (geom/io/strand_file.h).
void warn_of_losses(const std::filesystem::path& path, const Strands& strands, Progress& progress);

}  // namespace pelage
