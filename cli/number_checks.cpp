// SPDX-License-Identifier: Apache-2.0
#include "cli/number_checks.h"

#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/nearest_name.h"

namespace pelage {
namespace {

/// NaN for a text that is not a number.
double number_of(const std::string& text) {
  double number = 0;
  const char* end = text.data() + text.size();
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [stop, error] = std::from_chars(begin, end, number);
  return error == std::errc() && stop == end ? number : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

FlagCheck positive_number() {
  return [](const std::string& text) -> std::string {
    const double value = number_of(text);
    const bool fits =
        value >= std::numeric_limits<float>::denorm_min() && value <= std::numeric_limits<float>::max();
    return fits ? "" : "expected a number greater than 0, got " + quote(text);
  };
}

FlagCheck whole_number() {
  return [](const std::string& text) -> std::string {
    int number = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    return error == std::errc() && stop == end ? "" : "expected a whole number, got " + quote(text);
  };
}

FlagCheck number_between(double min, double max) {
  return [=](const std::string& text) -> std::string {
    const double value = number_of(text);
    return value >= min && value <= max
               ? ""
               : fmt::format("expected a number from {} to {}, got {}", min, max, quote(text));
  };
}

}  // namespace pelage
