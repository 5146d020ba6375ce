// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lab/report/report.h"

namespace pelage {

/// Returns a report as one self-contained HTML page without scripts, also suitable for printing. The style
/// sheet, plots (SVG) and pictures (PNG) are embedded. Tables and figures are numbered. The page is also
/// well-formed XML.
std::string report_html(const Report& report);

/// Returns the plots of a report as files for papers and slides: pairs of name and content. The names are
/// numbered as the figures on the page: "figure-03.svg".
std::vector<std::pair<std::string, std::string>> report_figures(const Report& report);

}  // namespace pelage
