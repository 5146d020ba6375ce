// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lab/report/report.h"

namespace pelage {

// Each function returns a plot as an inline SVG element, with axes, units, grid and legend. Numbers that are
// not finite leave gaps.

std::string line_plot_svg(const LinePlot& plot);
std::string bar_plot_svg(const BarPlot& plot);

}  // namespace pelage
