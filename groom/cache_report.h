// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/content_store.h"
#include "groom/groom_identity.h"

namespace pelage {

/// What became of a groom's cache when the groom was made, and why.
struct GroomCacheReport {
  struct Stage {
    std::string name;
    bool fresh = false;
    std::string reason;  ///< why it is not: "amount: 0.6 -> 0.5"
  };
  bool fresh = false;         ///< everything was read, nothing had to be grown
  bool stored = false;        ///< it stands in a file now
  std::vector<Stage> stages;  ///< skin, strands, points, frozen operators
  size_t resumed = 0;         ///< frozen operators whose result was still there
  std::filesystem::path file;
  std::vector<std::filesystem::path> files;  ///< all that the groom now has in the folder
  size_t strands = 0;
  size_t offset_bytes = 0, follicle_bytes = 0;  ///< of what rendering reads, as files
  double seconds = 0;

  /// "fresh" or what is stale and why, in one line.
  std::string summary() const;
};

/// What a groom was made from the last time, kept beside its cache to say what has changed and what is no
/// longer needed. No strand depends on it.
class GroomManifest {
 public:
  /// The first `count` stages of a groom.
  GroomManifest(const GroomIdentity& identity, size_t count);
  /// Nothing when there is none, or a damaged one.
  static std::optional<GroomManifest> read(const ContentStore& store, const std::string& groom);
  /// Failing to is no harm.
  void write(const ContentStore& store, const std::string& groom) const;

  const std::vector<GroomStage>& stages() const { return stages_; }

  /// The files of a state of the groom: what growing it anew would write.
  struct State {
    std::string offsets, follicles;  ///< names in the folder
    bool operator==(const State&) const = default;
  };
  /// The states of late, the latest first.
  const std::vector<State>& states() const { return states_; }
  /// Puts the present one before those of the manifest that this one takes the place of. Those that are eight
  /// states behind, and not used for a day, are forgotten, and their files removed.
  void add_state(State now, const std::optional<GroomManifest>& before, const ContentStore& store);
  static std::filesystem::path file(const ContentStore& store, const std::string& groom);
  /// As `pelage info` shows it.
  std::string text() const;

 private:
  GroomManifest() = default;
  std::vector<GroomStage> stages_;
  std::vector<State> states_;
};

/// Compares stages with what they were: a stage is fresh when nothing before or in it has changed.
std::vector<GroomCacheReport::Stage> explain(const GroomManifest& now,
                                             const std::optional<GroomManifest>& before);

}  // namespace pelage
