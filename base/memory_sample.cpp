// SPDX-License-Identifier: Apache-2.0
#include "base/memory_sample.h"

#include <fstream>
#include <numeric>
#include <string>

namespace pelage {

ResidentMemory resident_memory() {
  ResidentMemory memory;
  std::ifstream status("/proc/self/status");
  // Lines such as "RssAnon:      1234 kB".
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("RssAnon:")) memory.anonymous = std::stoll(line.substr(8)) * 1024;
    if (line.starts_with("RssFile:")) {
      memory.file = std::stoll(line.substr(8)) * 1024;
      break;  // comes after RssAnon
    }
  }
  return memory;
}

int64_t MemorySample::tagged() const { return std::accumulate(tags.begin(), tags.end(), int64_t{0}); }

}  // namespace pelage
