// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "world/statistics.h"

namespace pelage {

/// Version of the JSON object that --stats writes. It is incremented when a name in this object is removed or
/// changes its meaning.
constexpr int kStatisticsSchema = 1;

/// Returns the statistics of a run as one JSON object. The names in it contain the units.
std::string statistics_json(const Statistics& statistics);

/// Writes this object to a file, completely or not at all. Throws Error (kFailed).
void write_statistics(const std::filesystem::path& path, const Statistics& statistics);

}  // namespace pelage
