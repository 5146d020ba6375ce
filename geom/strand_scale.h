// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

/// How finely the strands of one coat need to be known, and where they are: what their coordinates may be
/// rounded to depends on this alone. The same for all strands of a coat in a frame, however it is divided.
struct StrandScale {
  float width = 0;   ///< of strands at their roots, about
  V3f anchor{0};     ///< a point near them
  float widest = 0;  ///< of the widest strands, about; 0 where that is not known
};

}  // namespace pelage
