// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace pelage {

/// The statistics that a run wrote with --stats.
class RunStatistics {
 public:
  /// Reads the file of --stats. Empty when the file is missing or damaged.
  static std::optional<RunStatistics> read(const std::filesystem::path& path);

  /// Returns a number by its path, which consists of the keys joined by dots: "stages_s.render". NaN when
  /// there is none.
  double number(const std::string& path) const;
  /// Returns the sum of all numbers in an object, such as "rays". NaN when there are none.
  double sum(const std::string& object) const;
  /// Returns the keys of an object that contains numbers, in alphabetical order.
  std::vector<std::string> keys(const std::string& object) const;

  /// Memory over time, as a table: names of the columns, and rows with one value per column. Empty for a run
  /// without --sample-memory.
  const std::vector<std::string>& timeline_columns() const { return timeline_columns_; }
  const std::vector<std::vector<double>>& timeline() const { return timeline_; }

  /// All statistics except the timeline, as a JSON object.
  const std::string& json() const { return json_; }

 private:
  std::map<std::string, double> numbers_;
  std::vector<std::string> timeline_columns_;
  std::vector<std::vector<double>> timeline_;
  std::string json_;
};

}  // namespace pelage
