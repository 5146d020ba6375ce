// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lab/report/report.h"
#include "lab/runs/variant.h"

namespace pelage {

/// Anonymous plus file-backed resident memory over time, one line per outcome with a timeline.
LinePlot resident_plot(const std::vector<Outcome>& outcomes, const std::string& caption);

/// For each outcome with a timeline, a half-width plot of the ledger's tags stacked over time below the
/// anonymous resident memory (above the baseline). All have the same axes.
std::vector<LinePlot> tag_plots(const std::vector<Outcome>& outcomes);

}  // namespace pelage
