// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pelage {

/// The quantity that a number in a report measures. It determines the unit and the format of the number.
enum class Quantity {
  kCount,    ///< an integer without unit
  kSeconds,  ///< seconds, shown in s or ms
  kBytes,    ///< bytes, shown in B, KiB, MiB or GiB
  kRate,     ///< number per second
  kRatio,    ///< a ratio without unit
  kPercent,  ///< a fraction, shown as a percentage with one decimal
  kError,    ///< a fraction, shown as a percentage with three decimals
};

/// The unit in which numbers of one column or axis are shown.
struct DisplayUnit {
  double factor = 1;   ///< the shown number is the raw number times this
  std::string symbol;  ///< such as "MiB"; empty: no unit
  int decimals = 0;    ///< number of decimals with which the largest number has three or four digits
};

/// Returns the unit in which numbers up to `largest` are easiest to read.
DisplayUnit display_unit(Quantity quantity, double largest);

/// Returns the unit of raw numbers in JSON and CSV: "bytes", "s", "1/s", or an empty text.
std::string_view raw_unit(Quantity quantity);

/// Returns a raw number in the unit `unit`, without the symbol of the unit: "12 345", "0.25", "∞", "–" for
/// NaN. Digits are in groups of three from 10 000 on.
std::string number_text(double number, const DisplayUnit& unit);

/// Returns a name with its unit, such as "peak memory (MiB)". Returns only the name when the unit has no
/// symbol.
std::string with_unit(const std::string& name, const DisplayUnit& unit);

}  // namespace pelage
