// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "lab/report/report.h"

namespace pelage {

/// Checks that a folder is writable before hours of work, by writing an empty report.json. Creates the
/// folder. Throws Error (kFailed).
void claim_report_folder(const std::filesystem::path& folder);

/// Writes report.html, report.json and report.csv. Throws Error (kFailed).
void write_report(const std::filesystem::path& folder, const Report& report);

/// Writes the plots as figures/figure-NN.svg and removes the plots of an earlier report. Throws Error
/// (kFailed).
void write_report_figures(const std::filesystem::path& folder, const Report& report);

}  // namespace pelage
