// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "base/content_store.h"
#include "groom/follicles/follicles.h"

namespace pelage {

class SurfaceTopology;

/// The cache of a user: follicles of coats, kept between runs for all scenes, without a key in a scene. It
/// changes no strand: stored follicles equal newly placed ones bit for bit. A missing, damaged or unwritable
/// cache is no error. Thread safety: const members may be called from any thread and by many
/// processes.
class GrowthCache {
 public:
  static constexpr uint64_t kMaxBytes = uint64_t(2) << 30;

  /// `max_bytes`: max total size of the files, beyond which those that were not used for longest are removed.
  explicit GrowthCache(std::filesystem::path folder, uint64_t max_bytes = kMaxBytes)
      : store_(std::move(folder)), max_bytes_(max_bytes) {}

  /// Returns the folder of this user: the value of PELAGE_CACHE, or else `pelage` in the folder
  /// XDG_CACHE_HOME or ~/.cache. Empty if PELAGE_CACHE is empty or "off", and if no folder is known.
  static std::filesystem::path folder_of_user();

  const std::filesystem::path& folder() const { return store_.folder(); }
  /// Returns the follicles with a key: those of the cache, or else those that place() returns, which it
  /// stores unless they are few. `warn` receives a line for a damaged file, which is replaced.
  FollicleTree follicles(const ContentHash& key, const SurfaceTopology& topology,
                         const std::function<FollicleTree()>& place, const WarningSink& warn) const;
  /// Removes all files, also those whose time of use seems to lie in the future because clocks differ.
  ContentStore::Removed clear() const { return store_.prune(std::chrono::seconds::min()); }

 private:
  ContentStore store_;
  uint64_t max_bytes_;
};

}  // namespace pelage
