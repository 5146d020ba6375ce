// SPDX-License-Identifier: Apache-2.0
#include "lab/report/machine.h"

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sstream>
#include <thread>

#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "base/parallel.h"
#include "base/version.h"

namespace pelage {
namespace {

std::string text_of(const char* path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::string date_text() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  return fmt::format("{:04}-{:02}-{:02} {:02}:{:02} UTC", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                     utc.tm_hour, utc.tm_min);
}

std::string memory_text() {
  const double bytes = double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGESIZE));
  return fmt::format("{:.1f} GiB", bytes / (1 << 30));
}

std::string system_text() {
  utsname system{};
  return ::uname(&system) == 0 ? fmt::format("{} {} {}", system.sysname, system.release, system.machine)
                               : "unknown";
}

}  // namespace

double load_average() {
  double load[1];
  return ::getloadavg(load, 1) == 1 ? load[0] : 0;
}

std::string processor_name(const std::string& cpuinfo) {
  std::istringstream lines(cpuinfo);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("model name")) continue;
    const size_t start = line.find_first_not_of(" \t", line.find(':') + 1);
    if (line.find(':') != std::string::npos && start != std::string::npos) return line.substr(start);
  }
  return "unknown";
}

std::vector<std::pair<std::string, std::string>> machine_facts() {
  return {
      {"Program", fmt::format("pelage {}, {}", version(), compiler())},
      {"Libraries", libraries()},
      {"Processor", processor_name(text_of("/proc/cpuinfo"))},
      {"Cores", fmt::format("{} usable of {}", available_processors(), std::thread::hardware_concurrency())},
      {"Memory", memory_text()},
      {"System", system_text()},
      {"Date", date_text()}};
}

}  // namespace pelage
