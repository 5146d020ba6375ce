// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/content_store.h"
#include "groom/groom_identity.h"

namespace pelage {

/// State of a groom's cache when the groom was made, with reasons.
struct GroomCacheReport {
  struct Stage {
    std::string name;
    bool fresh = false;
    std::string reason;  ///< why it is stale: "amount: 0.6 -> 0.5"
  };
  bool fresh = false;         ///< everything was read, nothing had to be grown
  bool stored = false;        ///< the groom is now stored in a file
  std::vector<Stage> stages;  ///< skin, strands, points, frozen operators
  size_t resumed = 0;         ///< frozen operators whose result was still available
  std::filesystem::path file;
  std::vector<std::filesystem::path> files;  ///< all files of the groom in the folder
  size_t strands = 0;
  size_t offset_bytes = 0, follicle_bytes = 0;  ///< of the files read for rendering
  double seconds = 0;

  /// "fresh", or the first stale stage with the reason, in one line.
  std::string summary() const;
};

/// The inputs from which a groom was made the last time. Stored beside its cache, to report changes and to
/// find files that are no longer needed. No strand depends on it.
class GroomManifest {
 public:
  /// The first `count` stages of a groom.
  GroomManifest(const GroomIdentity& identity, size_t count);
  /// Empty when missing or damaged.
  static std::optional<GroomManifest> read(const ContentStore& store, const std::string& groom);
  /// Ignores failures.
  void write(const ContentStore& store, const std::string& groom) const;

  const std::vector<GroomStage>& stages() const { return stages_; }

  /// The files that growing the groom in one state would write.
  struct State {
    std::string offsets, follicles;  ///< names in the folder
    bool operator==(const State&) const = default;
  };
  /// Recent states, the latest first.
  const std::vector<State>& states() const { return states_; }
  /// Inserts the current state before the states of `before`, which is the manifest that this manifest
  /// replaces. Drops states that are followed by eight later ones and have not been used for a day, and
  /// removes their files.
  void add_state(State now, const std::optional<GroomManifest>& before, const ContentStore& store);
  static std::filesystem::path file(const ContentStore& store, const std::string& groom);
  /// The text that `pelage info` shows.
  std::string text() const;

 private:
  GroomManifest() = default;
  std::vector<GroomStage> stages_;
  std::vector<State> states_;
};

/// Compares stages with the previous ones: a stage is fresh when neither it nor a stage before it has
/// changed.
std::vector<GroomCacheReport::Stage> explain(const GroomManifest& now,
                                             const std::optional<GroomManifest>& before);

}  // namespace pelage
