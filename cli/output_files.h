// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/options.h"

namespace pelage {

/// Throws Error (kArguments) when `output`, given by `flag`, is one of the files in `kept`, under any name:
/// it would replace it.
void check_replaces_none(const std::string& flag, const std::filesystem::path& output,
                         const std::vector<std::filesystem::path>& kept);

/// The same for `--stats`, where it is given.
void check_stats(const Options& options, const std::vector<std::filesystem::path>& kept);

/// Before long work: throws Error (kFailed) when `path` cannot be written, and removes what killed runs have
/// left half-written beside it.
void prepare_output(const std::filesystem::path& path);

}  // namespace pelage
