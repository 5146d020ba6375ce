// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lab/report/report.h"

namespace pelage {

/// A table as CSV [RFC 4180]: a line of keys, then a line per row, in raw units. Numbers are written with the
/// fewest digits that round-trip; unknown ones are empty, infinite ones "inf" and "-inf".
std::string csv_text(const Table& table);

}  // namespace pelage
