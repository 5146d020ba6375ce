// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lab/report/report.h"

namespace pelage {

/// Version of the JSON object that `pelage measure` writes. It is incremented when a name in this object is
/// removed or changes its meaning.
constexpr int kReportSchema = 1;

/// Returns a report as one JSON object: the configuration, the measurements (one row per variant, in raw
/// units), and the statistics that every run wrote. Numbers that are not finite are null.
std::string report_json(const Report& report);

}  // namespace pelage
