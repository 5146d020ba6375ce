// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lab/runs/variant.h"

namespace pelage {

/// Ratio of a number between two variants. `typical` compares their typical runs; `min` and `max` are over
/// all pairs of a run of one and a run of the other.
struct RatioSpread {
  double typical = 0, min = 0, max = 0;
};
/// Returns the ratio of the number at `path` in `above` to the same number in `below`.
RatioSpread ratio_of(const Outcome& above, const Outcome& below, const std::string& path);

/// Returns a text such as "1.84 (1.79 to 1.90)". Omits the range if min and max are equal, as when each
/// variant ran once.
std::string spread_text(const RatioSpread& ratio);

}  // namespace pelage
