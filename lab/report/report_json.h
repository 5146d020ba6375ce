// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lab/report/report.h"

namespace pelage {

/// Version of the object that `pelage measure` writes: incremented when a name changes its meaning or is
/// removed.
constexpr int kReportSchema = 1;

/// The configuration, the measurements (raw units, one row per variant) and every run's own statistics as one
/// JSON object. Non-finite numbers are null.
std::string report_json(const Report& report);

}  // namespace pelage
