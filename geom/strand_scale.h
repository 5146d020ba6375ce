// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

/// Determines how the coordinates of a coat's strands are rounded: from the widths of the strands, which give
/// the required precision, and from their approximate position. All strands of a coat have the same scale in
/// a frame, however the coat is divided into chunks.
struct StrandScale {
  float width = 0;   ///< approximate width of the strands at their roots
  V3f anchor{0};     ///< a point near the strands
  float widest = 0;  ///< approximate width of the widest strands; 0 when unknown
};

}  // namespace pelage
