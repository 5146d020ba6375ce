// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

/// Required precision and approximate position of the strands of one coat; they determine how coordinates are
/// rounded. All strands of a coat in a frame have the same scale, however the coat is divided into chunks.
struct StrandScale {
  float width = 0;   ///< approximate width of strands at their roots
  V3f anchor{0};     ///< a point near the strands
  float widest = 0;  ///< approximate width of the widest strands; 0 when unknown
};

}  // namespace pelage
