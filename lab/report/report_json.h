// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lab/report/report.h"

namespace pelage {

/// Version of the object that `pelage measure` writes: goes up when a name changes its meaning or vanishes.
constexpr int kReportSchema = 1;

/// What was run, what was measured (raw units, a row per variant) and every run's own statistics as one JSON
/// object. Numbers that are not finite are null.
std::string report_json(const Report& report);

}  // namespace pelage
