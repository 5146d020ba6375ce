// SPDX-License-Identifier: Apache-2.0
#include "base/shared_folders.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string>

namespace pelage {

bool is_shared_folder(const std::filesystem::path& folder) {
  const char* named = std::getenv(kSharedCachesVariable);
  if (!named) return false;
  std::error_code error;
  const std::filesystem::path place = std::filesystem::canonical(folder, error);
  if (error) return false;
  std::istringstream list(named);
  for (std::string name; std::getline(list, name, ':');) {
    if (name.empty()) continue;
    const std::filesystem::path shared = std::filesystem::canonical(name, error);
    if (error) continue;
    const auto [end, ignored] = std::mismatch(shared.begin(), shared.end(), place.begin(), place.end());
    if (end == shared.end()) return true;
  }
  return false;
}

}  // namespace pelage
