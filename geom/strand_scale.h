// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"

namespace pelage {

/// Precision that the strands of one coat need, and their position: determines how coordinates may be
/// rounded. The same for all strands of a coat in a frame, however it is divided.
struct StrandScale {
  float width = 0;   ///< approximate width of strands at their roots
  V3f anchor{0};     ///< a point near them
  float widest = 0;  ///< approximate width of the widest strands; 0 when unknown
};

}  // namespace pelage
