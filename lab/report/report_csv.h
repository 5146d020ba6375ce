// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lab/report/report.h"

namespace pelage {

/// Returns a table as CSV [RFC 4180]: a line of keys, then a line per row, in raw units. A number has the
/// fewest digits from which it can be read back exactly. An unknown number is an empty field. Infinite
/// numbers are "inf" and "-inf".
std::string csv_text(const Table& table);

}  // namespace pelage
