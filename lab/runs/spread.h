// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lab/runs/variant.h"

namespace pelage {

/// Ratio of one number between two variants: for their typical runs, and the min and max over all pairs of
/// runs.
struct RatioSpread {
  double typical = 0, min = 0, max = 0;
};
RatioSpread ratio_of(const Outcome& above, const Outcome& below, const std::string& path);

/// "1.84 (1.79 to 1.90)"; without the spread when each variant ran once.
std::string spread_text(const RatioSpread& ratio);

}  // namespace pelage
