// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "world/statistics.h"

namespace pelage {

/// Version of the object that --stats writes: incremented when a name changes its meaning or is removed.
constexpr int kStatisticsSchema = 1;

/// The numbers of a run as one JSON object, with units in the names.
std::string statistics_json(const Statistics& statistics);

/// Writes that object, completely or not at all. Throws Error (kFailed).
void write_statistics(const std::filesystem::path& path, const Statistics& statistics);

}  // namespace pelage
