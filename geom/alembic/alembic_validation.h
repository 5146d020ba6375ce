// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "geom/interchange/validation_report.h"

namespace pelage {

/// Checks the curves of an Alembic file as validate_usd() does: that there are any, numbers that are not
/// finite, curves with fewer points than they need, counts that do not fit or that change over time, widths
/// (width or groom_width) that are missing, too few or negative, and bounds (.selfBnds) that are smaller than
/// the points; and, as remarks, missing texture coordinates of roots and ids. Does not count the phantom
/// vertices of curves that Pelage wrote as points. Checks at most 64 times as many bytes as the file has.
/// Throws Error (kInput) as read_alembic_curves() does.
ValidationReport validate_alembic(const std::filesystem::path& path);

}  // namespace pelage
