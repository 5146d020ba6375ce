// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pelage {

/// What a number of a report counts. Decides its unit and how it is written.
enum class Quantity {
  kCount,    ///< whole things
  kSeconds,  ///< shown in s or ms
  kBytes,    ///< shown in B, KiB, MiB or GiB
  kRate,     ///< per second
  kRatio,    ///< without unit
  kPercent,  ///< given as a fraction, shown as a percentage
};

/// The unit in which numbers of one column or axis are shown.
struct DisplayUnit {
  double factor = 1;   ///< shown = number * factor
  std::string symbol;  ///< "MiB"; empty: none
  int decimals = 0;    ///< so that the largest has three or four digits
};

/// The unit in which numbers up to `largest` read best.
DisplayUnit display_unit(Quantity quantity, double largest);

/// The unit in which raw numbers are kept in JSON and CSV: "bytes", "s", "1/s", or empty.
std::string_view raw_unit(Quantity quantity);

/// A number in its unit, digits in groups of three: "12 345", "0.25", "∞", "–" when it is not a number.
std::string number_text(double number, const DisplayUnit& unit);

/// "peak memory (MiB)", or only the name where there is no unit.
std::string with_unit(const std::string& name, const DisplayUnit& unit);

}  // namespace pelage
