// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "lab/measure/bounds_variants.h"
#include "lab/pictures/picture_difference.h"
#include "lab/report/report.h"

namespace pelage {

/// What `measure bounds` found: outcomes in the order in which they are shown, the strategies first, then one
/// per switch, and how the picture of each differs from that of none (nothing where one of the two failed).
struct BoundsResults {
  std::vector<Outcome> outcomes;
  size_t strategies = 0;  ///< of the outcomes, the first
  std::vector<std::optional<PictureDifference>> differences;
  std::optional<Picture> picture;  ///< of none
  bool cached = false;             ///< the scene's grooms have caches
  int repeat = 1;
};

Report bounds_report(const BoundsResults& results);

}  // namespace pelage
