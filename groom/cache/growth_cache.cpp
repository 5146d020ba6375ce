// SPDX-License-Identifier: Apache-2.0
#include "groom/cache/growth_cache.h"

#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

#include "groom/cache/stored_follicles.h"

namespace pelage {
namespace {

/// Fewer follicles are placed within some hundredths of a second.
constexpr size_t kMinStored = 5000;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

}  // namespace

std::filesystem::path GrowthCache::folder_of_user() {
  if (std::getenv("PELAGE_CACHE")) {
    const std::string folder = environment("PELAGE_CACHE");
    return folder == "off" ? "" : folder;
  }
  // The XDG base directory specification: relative paths are ignored.
  const std::filesystem::path shared = environment("XDG_CACHE_HOME"), home = environment("HOME");
  if (shared.is_absolute()) return shared / "pelage";
  return home.is_absolute() ? home / ".cache" / "pelage" : "";
}

FollicleTree GrowthCache::follicles(const ContentHash& key, const SurfaceTopology& topology,
                                    const std::function<FollicleTree()>& place,
                                    const WarningSink& warn) const {
  if (std::optional<FollicleTree> stored = stored_follicles(store_, key, &topology, warn))
    return std::move(*stored);
  FollicleTree placed = place();
  // Processes that place the same follicles at once write the same file, each as a whole.
  if (placed.size() >= kMinStored && store_follicles(store_, key, placed, [](const std::string&) {})) {
    store_.sweep();
    store_.prune(ContentStore::kUnusedAge);
    store_.shrink(max_bytes_);
  }
  return placed;
}

}  // namespace pelage
