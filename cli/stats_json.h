// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "world/statistics.h"

namespace pelage {

/// Version of the object that --stats writes: goes up when a name changes its meaning or vanishes.
constexpr int kStatisticsSchema = 1;

/// The numbers of a run as one JSON object (design.md section 7), units in names.
std::string statistics_json(const Statistics& statistics);

/// Writes it, whole or not at all. Throws Error (kFailed).
void write_statistics(const std::filesystem::path& path, const Statistics& statistics);

}  // namespace pelage
