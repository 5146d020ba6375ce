// SPDX-License-Identifier: Apache-2.0
#include "lab/measure/caches.h"

#include <system_error>

namespace pelage {

CacheFolders::CacheFolders(const SceneDescription& scene, const std::filesystem::path& folder)
    : folder_(std::filesystem::absolute(folder) / "caches") {
  for (const auto& [name, position, groom] : scene.grooms.items) {
    if (groom.cache) grooms_.push_back(name);
  }
}

std::vector<std::string> CacheFolders::arguments(const std::string& name) const {
  std::vector<std::string> arguments;
  for (const std::string& groom : grooms_) {
    arguments.push_back("--set");
    arguments.push_back("grooms." + groom + ".cache.directory=" + yaml_quoted(folder(name).string()));
  }
  return arguments;
}

void CacheFolders::clear(const std::string& name) const { std::filesystem::remove_all(folder(name)); }

std::string yaml_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

double folder_bytes(const std::filesystem::path& folder, const std::string& prefix) {
  double bytes = 0;
  std::error_code failure;
  for (std::filesystem::recursive_directory_iterator it(folder, failure), end; !failure && it != end;
       it.increment(failure)) {
    if (it->is_regular_file(failure) && it->path().filename().string().starts_with(prefix))
      bytes += static_cast<double>(it->file_size(failure));
  }
  return bytes;
}

}  // namespace pelage
