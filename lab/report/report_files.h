// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "lab/report/report.h"

namespace pelage {

/// Checks that a folder is writable, before hours of work. Creates the folder if necessary, and writes an
/// empty report.json to it. Throws Error (kFailed) when this is not possible.
void claim_report_folder(const std::filesystem::path& folder);

/// Writes report.html, report.json and report.csv to a folder. Throws Error (kFailed).
void write_report(const std::filesystem::path& folder, const Report& report);

}  // namespace pelage
