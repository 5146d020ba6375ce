// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lab/report/report.h"
#include "lab/runs/variant.h"

namespace pelage {

/// Returns a plot of resident memory over time, anonymous plus file-backed, with one line per outcome that
/// has a timeline.
LinePlot resident_plot(const std::vector<Outcome>& outcomes, const std::string& caption);

/// Returns one plot of half width for each outcome that has a timeline. It shows memory over time: the
/// ledger's tags as stacked areas, and the anonymous resident memory minus the baseline as a line. All plots
/// have the same axes.
std::vector<LinePlot> tag_plots(const std::vector<Outcome>& outcomes);

}  // namespace pelage
