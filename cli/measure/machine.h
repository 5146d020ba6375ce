// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pelage {

/// What a reader of a report wants to know of where it was measured: processor, cores, memory, system, load,
/// date (UTC), program version. "unknown" where the system does not say.
std::vector<std::pair<std::string, std::string>> machine_facts();

/// "model name" of a text as in /proc/cpuinfo; "unknown" without one.
std::string processor_name(const std::string& cpuinfo);

}  // namespace pelage
