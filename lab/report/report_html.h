// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lab/report/report.h"

namespace pelage {

/// A report as one self-contained HTML page: style sheet, plots (SVG) and pictures (PNG) are embedded,
/// without scripts. Tables and figures are numbered. Also well-formed XML. Suitable for printing.
std::string report_html(const Report& report);

/// Its plots as separate files, for papers and slides: names ("figure-03.svg", numbered as on the page) and
/// contents.
std::vector<std::pair<std::string, std::string>> report_figures(const Report& report);

}  // namespace pelage
