// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lab/report/report.h"

namespace pelage {

/// A report as one HTML page that needs nothing else: style sheet, plots (SVG) and pictures (PNG) stand in
/// it, there are no scripts. Tables and figures are numbered. Well-formed as XML too. Made to be printed.
std::string report_html(const Report& report);

/// Its plots as files of their own, for papers and slides: names ("figure-03.svg", numbered as on the page)
/// and contents.
std::vector<std::pair<std::string, std::string>> report_figures(const Report& report);

}  // namespace pelage
