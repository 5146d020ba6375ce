// SPDX-License-Identifier: Apache-2.0
#include "lab/report/quantity.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace pelage {
namespace {

int decimals_for(double largest) {
  if (largest >= 1000) return 0;
  if (largest >= 100) return 1;
  return largest >= 10 ? 2 : 3;
}

// Groups of three with narrow no-break spaces, from ten thousand on.
std::string grouped(const std::string& digits) {
  const size_t start = digits.starts_with('-') ? 1 : 0;
  const size_t point = std::min(digits.find('.'), digits.size());
  if (point - start < 5) return digits;
  std::string out;
  for (size_t i = 0; i < digits.size(); ++i) {
    if (i > start && i < point && (point - i) % 3 == 0) out += "\u202f";
    out += digits[i];
  }
  return out;
}

}  // namespace

DisplayUnit display_unit(Quantity quantity, double largest) {
  largest = std::isfinite(largest) ? std::abs(largest) : 0;
  const auto unit = [&](double factor, const char* symbol) {
    return DisplayUnit{factor, symbol, decimals_for(largest * factor)};
  };
  switch (quantity) {
    case Quantity::kCount:
      return {1, "", 0};
    case Quantity::kSeconds:
      return largest > 0 && largest < 0.1 ? unit(1e3, "ms") : unit(1, "s");
    case Quantity::kBytes:
      if (largest < 1024) return {1, "B", largest < 1000 ? 1 : 0};
      if (largest < 1024.0 * 1024) return unit(1.0 / 1024, "KiB");
      if (largest < 10 * 1024.0 * 1024 * 1024) return unit(1.0 / (1 << 20), "MiB");
      return unit(1.0 / (1 << 30), "GiB");
    case Quantity::kRate:
      return {1, "1/s", largest < 100 ? 2 : 0};
    case Quantity::kRatio:
      return unit(1, "");
    case Quantity::kPercent:
      return {100, "%", 1};
    case Quantity::kError:
      return {100, "%", 3};
  }
  return {};
}

std::string_view raw_unit(Quantity quantity) {
  switch (quantity) {
    case Quantity::kSeconds:
      return "s";
    case Quantity::kBytes:
      return "bytes";
    case Quantity::kRate:
      return "1/s";
    default:
      return "";
  }
}

std::string number_text(double number, const DisplayUnit& unit) {
  if (std::isnan(number)) return "–";
  if (std::isinf(number)) return number > 0 ? "∞" : "−∞";
  std::string text = fmt::format("{:.{}f}", number * unit.factor, unit.decimals);
  if (text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  text = grouped(text);
  return text.starts_with('-') ? "−" + text.substr(1) : text;
}

std::string with_unit(const std::string& name, const DisplayUnit& unit) {
  return unit.symbol.empty() ? name : name + " (" + unit.symbol + ")";
}

}  // namespace pelage
