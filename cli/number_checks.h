// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace pelage {

/// A check for the value of a flag. Returns a message for a text that is refused, and an empty text
/// otherwise.
using FlagCheck = std::function<std::string(const std::string& text)>;

/// Accepts finite decimal numbers that are greater than 0, also after rounding to float.
FlagCheck positive_number();

/// Accepts whole numbers that fit an int.
FlagCheck whole_number();

/// Accepts decimal numbers from `min` to `max`.
FlagCheck number_between(double min, double max);

}  // namespace pelage
