// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "geom/interchange/validation_report.h"

namespace pelage {

/// Checks the curves of a USD file: that there are any, numbers that are not finite, curves with fewer points
/// than they need, counts that do not fit or that change over time, widths that are missing or negative,
/// extents that are missing or too small at any time sample; and, as remarks, missing texture coordinates of
/// roots and ids. Throws Error (kInput) as read_usd_curves() does for malformed text.
ValidationReport validate_usd(const std::filesystem::path& path);

}  // namespace pelage
