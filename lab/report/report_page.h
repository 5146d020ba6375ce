// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "base/page_file.h"
#include "lab/report/report.h"

namespace pelage {

/// Returns all files of lab/report/page/.
std::span<const PageFile> report_page_files();

/// Returns a report as one self-contained HTML page, for light and dark screens and for paper. It holds the
/// report as JSON, and a script that draws the plots. It loads nothing. Tables and figures are numbered.
std::string report_page(const Report& report);

}  // namespace pelage
