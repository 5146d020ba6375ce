// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/content_store.h"
#include "groom/cache/groom_identity.h"

namespace pelage {

/// State of a groom's cache at the moment when the groom was made, with the reasons for that state.
struct GroomCacheReport {
  struct Stage {
    std::string name;
    bool fresh = false;
    std::string reason;  ///< reason why the stage is stale: "amount: 0.6 -> 0.5"
  };
  bool fresh = false;         ///< whether everything was read from the cache and nothing had to be grown
  bool stored = false;        ///< whether the groom is now stored in a file
  std::vector<Stage> stages;  ///< the skin, the strands, the points and each frozen operator
  size_t resumed = 0;         ///< number of frozen operators whose result was still in the cache
  std::filesystem::path file;
  std::vector<std::filesystem::path> files;  ///< all files of the groom in the cache folder
  size_t strands = 0;
  size_t offset_bytes = 0, follicle_bytes = 0;  ///< sizes of the files that were read for rendering
  double seconds = 0;

  /// Returns "fresh", or one line with the first stale stage and the reason.
  std::string summary() const;
};

/// The inputs from which a groom was last made. Stored beside the groom's cache, to tell the user what
/// changed and to find files that are no longer needed. It has no influence on the strands.
class GroomManifest {
 public:
  /// Records the first `count` stages of a groom.
  GroomManifest(const GroomIdentity& identity, size_t count);
  /// Reads the manifest of a groom. Empty when it is missing or damaged.
  static std::optional<GroomManifest> read(const ContentStore& store, const std::string& groom);
  /// Stores the manifest. Ignores failures to write it.
  void write(const ContentStore& store, const std::string& groom) const;

  const std::vector<GroomStage>& stages() const { return stages_; }

  /// Names of the files that the cache holds for one state of the groom's inputs.
  struct State {
    std::string offsets, follicles;  ///< file names without folder
    bool operator==(const State&) const = default;
  };
  /// Recent states, the most recent first.
  const std::vector<State>& states() const { return states_; }
  /// Sets the states to `now`, followed by the states of `before`, the manifest that this one replaces. Drops
  /// a state and removes its files if at least eight states are newer and its files have not been used for a
  /// day.
  void add_state(State now, const std::optional<GroomManifest>& before, const ContentStore& store);
  static std::filesystem::path file(const ContentStore& store, const std::string& groom);
  /// Returns the text that `pelage info` shows.
  std::string text() const;

 private:
  GroomManifest() = default;
  std::vector<GroomStage> stages_;
  std::vector<State> states_;
};

/// Compares the stages of a groom with those of `before`. A stage is fresh if neither this stage nor any
/// stage before it has changed. All stages are stale without `before`.
std::vector<GroomCacheReport::Stage> explain(const GroomManifest& now,
                                             const std::optional<GroomManifest>& before);

}  // namespace pelage
