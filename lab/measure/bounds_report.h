// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "lab/measure/bounds_variants.h"
#include "lab/pictures/picture_difference.h"
#include "lab/report/report.h"

namespace pelage {

/// Results of `measure bounds`: outcomes in display order, first the strategies, then one per switch; and the
/// difference of each picture from the picture of strategy none (empty if either run failed).
struct BoundsResults {
  std::vector<Outcome> outcomes;
  size_t strategies = 0;  ///< number of outcomes, from the first, that are strategies
  std::vector<std::optional<PictureDifference>> differences;
  std::optional<Picture> picture;  ///< picture of strategy none
  bool cached = false;             ///< whether the scene's grooms have caches
  int repeat = 1;
};

Report bounds_report(const BoundsResults& results);

}  // namespace pelage
