// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pelage {

/// Facts about the machine and program for a report: processor, cores, memory, system, date (UTC), program
/// version, compiler and libraries. "unknown" where the system does not provide them.
std::vector<std::pair<std::string, std::string>> machine_facts();

/// Load average of the last minute; 0 where the system does not provide it.
double load_average();

/// The value of "model name" in a text like /proc/cpuinfo; "unknown" without one.
std::string processor_name(const std::string& cpuinfo);

}  // namespace pelage
