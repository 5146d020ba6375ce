// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pelage {

/// Returns facts about machine and program for a report: processor, cores, memory, system, date (UTC),
/// program version, compiler and libraries. A fact that the system does not provide is "unknown".
std::vector<std::pair<std::string, std::string>> machine_facts();

/// Returns the load average of the last minute, or 0 if the system does not provide it.
double load_average();

/// Returns the value of "model name" in the text of /proc/cpuinfo, or "unknown" if it is missing.
std::string processor_name(const std::string& cpuinfo);

}  // namespace pelage
