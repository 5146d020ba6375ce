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

/// Writes the plots of a report to `folder`/figures as figure-NN.svg. First removes the plots of an earlier
/// report there. Throws Error (kFailed).
void write_report_figures(const std::filesystem::path& folder, const Report& report);

}  // namespace pelage
