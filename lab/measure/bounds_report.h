// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "lab/measure/bounds_variants.h"
#include "lab/pictures/picture_difference.h"
#include "lab/report/report.h"

namespace pelage {

/// Results of `measure bounds`.
struct BoundsResults {
  /// In display order: first the strategies, then one outcome per switch.
  std::vector<Outcome> outcomes;
  size_t strategies = 0;  ///< number of strategies: they are the first elements of `outcomes`
  /// For each outcome: difference of its picture from the picture of strategy none; empty if either run
  /// failed.
  std::vector<std::optional<PictureDifference>> differences;
  std::optional<Picture> picture;  ///< picture of strategy none
  bool cached = false;             ///< whether any of the scene's grooms has a cache
  int repeat = 1;                  ///< number of runs of each variant
};

Report bounds_report(const BoundsResults& results);

}  // namespace pelage
