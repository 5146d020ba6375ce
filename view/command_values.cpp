// SPDX-License-Identifier: Apache-2.0
#include "view/command_values.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/nearest_name.h"

namespace pelage {

void refuse_command(const std::string& message) { throw Error(ErrorKind::kArguments, message); }

void check_object(const nlohmann::json& value, const std::string& name, std::span<const std::string> keys) {
  if (!value.is_object()) refuse_command(name + ": expected an object");
  for (const auto& [key, unused] : value.items()) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
      refuse_command(name + ": unknown key " + quote(key) + suggest(key, keys));
  }
}

nlohmann::json read_object(const std::string& text, std::span<const std::string> keys) {
  nlohmann::json value = nlohmann::json::parse(text, nullptr, false);
  if (value.is_discarded()) refuse_command("the request is not JSON");
  check_object(value, "the request", keys);
  return value;
}

std::vector<double> read_numbers(const nlohmann::json& value, const std::string& name, size_t count,
                                 double min, double max) {
  std::vector<double> numbers;
  if (value.is_array()) {
    for (const nlohmann::json& item : value) {
      const double number = item.is_number() ? item.get<double>() : std::nan("");
      if (number >= min && number <= max) numbers.push_back(number);
    }
  }
  if (numbers.size() != count || value.size() != count)
    refuse_command(fmt::format("{}: expected {} from {} to {}", name,
                               count == 1 ? "a list of 1 number" : fmt::format("{} numbers", count), min,
                               max));
  return numbers;
}

double read_number(const nlohmann::json& value, const std::string& name, double min, double max) {
  const double number = value.is_number() ? value.get<double>() : std::nan("");
  if (!(number >= min && number <= max))
    refuse_command(fmt::format("{}: expected a number from {} to {}", name, min, max));
  return number;
}

std::string read_choice(const nlohmann::json& object, const std::string& key,
                        std::span<const std::string> choices) {
  const auto found = object.find(key);
  const std::string text = found != object.end() && found->is_string() ? found->get<std::string>() : "";
  if (std::find(choices.begin(), choices.end(), text) == choices.end())
    refuse_command(key + ": unknown value " + quote(text) + suggest(text, choices));
  return text;
}

}  // namespace pelage
