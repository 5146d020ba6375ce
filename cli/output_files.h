// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/options.h"

namespace pelage {

/// Throws Error (kArguments) when writing `output` would replace one of the files in `kept`, even if the
/// paths differ. `flag`: the flag that names `output`.
void check_replaces_none(const std::string& flag, const std::filesystem::path& output,
                         const std::vector<std::filesystem::path>& kept);

/// The same for `--stats`, if given.
void check_stats(const Options& options, const std::vector<std::filesystem::path>& kept);

/// Call before long work: throws Error (kFailed) when `path` cannot be written, and removes incomplete files
/// of killed runs beside it.
void prepare_output(const std::filesystem::path& path);

}  // namespace pelage
