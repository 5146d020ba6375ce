// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lab/report/report.h"

namespace pelage {

// Plots as inline SVG elements: axes with units, grid, legend. Non-finite numbers leave gaps.

std::string line_plot_svg(const LinePlot& plot);
std::string bar_plot_svg(const BarPlot& plot);

}  // namespace pelage
