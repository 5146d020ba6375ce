// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pelage {

/// The quantity that a number in a report measures; determines its unit and format.
enum class Quantity {
  kCount,    ///< integers
  kSeconds,  ///< shown in s or ms
  kBytes,    ///< shown in B, KiB, MiB or GiB
  kRate,     ///< per second
  kRatio,    ///< without unit
  kPercent,  ///< given as a fraction, shown as a percentage
  kError,    ///< the same, with three decimals
};

/// The unit in which numbers of one column or axis are shown.
struct DisplayUnit {
  double factor = 1;   ///< shown = number * factor
  std::string symbol;  ///< "MiB"; empty: none
  int decimals = 0;    ///< so that the largest has three or four digits
};

/// The unit in which numbers up to `largest` are easiest to read.
DisplayUnit display_unit(Quantity quantity, double largest);

/// The unit of raw numbers in JSON and CSV: "bytes", "s", "1/s", or empty.
std::string_view raw_unit(Quantity quantity);

/// A number in its unit, digits in groups of three: "12 345", "0.25", "∞", "–" for NaN.
std::string number_text(double number, const DisplayUnit& unit);

/// "peak memory (MiB)", or only the name when there is no unit.
std::string with_unit(const std::string& name, const DisplayUnit& unit);

}  // namespace pelage
