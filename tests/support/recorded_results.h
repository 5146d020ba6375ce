// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "groom/cache/groom_identity.h"

namespace pelage {

/// Numbers that a stage of growth (or another stage whose results are stored in files) computes from a fixed
/// input, condensed to a few numbers that show whether any of them has changed.
class StageResult {
 public:
  /// Adds a list of numbers. Names are unique.
  template <class T>
  void add(const std::string& name, std::span<const T> values) {
    std::vector<double> numbers(values.begin(), values.end());
    add_numbers(name, numbers, content_hash(std::as_bytes(values)));
  }
  template <class T>
  void add(const std::string& name, const std::vector<T>& values) {
    add(name, std::span<const T>(values));
  }

 private:
  friend class RecordedResults;
  /// Sums that hardly depend on the last digits: the size of the numbers (the root of the sum of squares),
  /// and sums with weights between -1 and 1 that depend on the place in the list.
  struct List {
    size_t count = 0;
    double size = 0;
    std::array<double, 4> sums{};
  };
  void add_numbers(const std::string& name, std::span<const double> values, const ContentHash& bytes);

  std::map<std::string, List> lists_;
  ContentHasher exact_;
};

/// The results of stages in tests/support/recorded_results.txt, with the versions of the code that made them.
///
/// Files of caches are found by these versions. Therefore a stage must give the recorded results as long as
/// its versions are the recorded ones. On machines whose library of functions gives the same bits as where
/// the results were recorded, results must be equal in every bit; on others, nearly equal.
///
/// With the environment variable PELAGE_RECORD_RESULTS=1, check() records the results of stages that are new
/// or have higher versions than before. With the name of a stage as its value, check() records this stage in
/// any case: for a test that has given it another input.
class RecordedResults {
 public:
  using Versions = std::vector<std::pair<std::string, int>>;  ///< of a stage and those before it: "clump", 1

  RecordedResults();
  /// Fails the test when the result is not what is recorded, or is not recorded. `change`: names the constant
  /// of the stage's own version.
  void check(const std::string& stage, const Versions& versions, const std::string& change,
             const StageResult& result);

 private:
  struct Entry {
    std::string machine, versions, exact;
    std::map<std::string, StageResult::List> lists;
  };
  void read();
  void write() const;
  static std::string difference(const Entry& recorded, const Entry& now);

  std::map<std::string, Entry> entries_;
};

/// The versions that are part of the identity of a groom, in the order of its steps.
inline RecordedResults::Versions growth_versions(const GroomIdentity& identity) {
  RecordedResults::Versions versions;
  for (const GroomStage& stage : identity.stages()) {
    for (const auto& [key, value] : stage.inputs) {
      if (key == "version") versions.emplace_back(stage.name, std::stoi(value));
      if (key == "fields") versions.emplace_back(key, std::stoi(value));
    }
  }
  return versions;
}

}  // namespace pelage
