// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace pelage {

/// The numbers that a run wrote with --stats. A value.
class RunStatistics {
 public:
  /// Empty when the file is missing or damaged.
  static std::optional<RunStatistics> read(const std::filesystem::path& path);

  /// A number by the path of its keys, "stages_s.render"; NaN when there is none.
  double number(const std::string& path) const;
  /// Sum of the numbers of an object, such as "rays"; NaN when there is none.
  double sum(const std::string& object) const;
  /// Keys of an object of numbers, in alphabetical order.
  std::vector<std::string> keys(const std::string& object) const;

  /// Memory over time: column names, and rows of the same length. Empty without --sample-memory.
  const std::vector<std::string>& timeline_columns() const { return timeline_columns_; }
  const std::vector<std::vector<double>>& timeline() const { return timeline_; }

  /// The object without its timeline, as JSON.
  const std::string& json() const { return json_; }

 private:
  std::map<std::string, double> numbers_;
  std::vector<std::string> timeline_columns_;
  std::vector<std::vector<double>> timeline_;
  std::string json_;
};

}  // namespace pelage
