// SPDX-License-Identifier: Apache-2.0
#include "lab/runs/run_statistics.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"

namespace pelage {
namespace {

using Json = nlohmann::ordered_json;

void flatten(const Json& json, const std::string& prefix, std::map<std::string, double>& numbers) {
  for (const auto& [key, value] : json.items()) {
    if (value.is_number()) numbers[prefix + key] = value.get<double>();
    if (value.is_object()) flatten(value, prefix + key + ".", numbers);
  }
}

}  // namespace

std::optional<RunStatistics> RunStatistics::read(const std::filesystem::path& path) {
  try {
    Json json = Json::parse(read_file(path));
    if (!json.is_object()) return {};
    RunStatistics statistics;
    if (json.contains("timeline")) {
      json.at("timeline_columns").get_to(statistics.timeline_columns_);
      json.at("timeline").get_to(statistics.timeline_);
      for (const std::vector<double>& row : statistics.timeline_) {
        if (row.size() != statistics.timeline_columns_.size()) return {};
      }
      json.erase("timeline");
      json.erase("timeline_columns");
    }
    flatten(json, "", statistics.numbers_);
    statistics.json_ = json.dump();
    return statistics;
  } catch (const Error&) {
    return {};
  } catch (const nlohmann::json::exception&) {
    return {};
  }
}

double RunStatistics::number(const std::string& path) const {
  const auto found = numbers_.find(path);
  return found == numbers_.end() ? NAN : found->second;
}

double RunStatistics::sum(const std::string& object) const {
  double sum = NAN;
  for (const std::string& key : keys(object)) sum = (std::isnan(sum) ? 0 : sum) + number(object + "." + key);
  return sum;
}

std::vector<std::string> RunStatistics::keys(const std::string& object) const {
  std::vector<std::string> keys;
  const std::string prefix = object + ".";
  for (const auto& [path, number] : numbers_) {
    if (path.starts_with(prefix) && path.find('.', prefix.size()) == std::string::npos)
      keys.push_back(path.substr(prefix.size()));
  }
  return keys;
}

}  // namespace pelage
