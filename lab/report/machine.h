// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pelage {

/// What a reader of a report wants to know of where it was measured: processor, cores, memory, system,
/// date (UTC), program version, compiler and libraries. "unknown" where the system does not say.
std::vector<std::pair<std::string, std::string>> machine_facts();

/// Processes that ran or waited to run, mean of the last minute; 0 where the system does not say.
double load_average();

/// "model name" of a text as in /proc/cpuinfo; "unknown" without one.
std::string processor_name(const std::string& cpuinfo);

}  // namespace pelage
