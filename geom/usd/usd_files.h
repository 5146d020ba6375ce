// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace pelage {

/// Returns whether the name of a file has an extension of USD.
bool is_usd_file(const std::filesystem::path& path);

/// Returns the files of a USD scene: the file itself, then every file that it and its layers name as
/// sublayer, reference or payload, also in variants that are not selected, each once. Leaves out files that
/// do not exist. A file that cannot be read names none.
std::vector<std::filesystem::path> usd_files(const std::filesystem::path& path);

/// Returns files of any kind, each followed by those that it names if it is of USD.
std::vector<std::filesystem::path> with_usd_files(const std::vector<std::filesystem::path>& files);

}  // namespace pelage
