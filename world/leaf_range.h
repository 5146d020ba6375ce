// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace pelage {

/// Consecutive leaves of a coat: first <= leaf < end.
struct LeafRange {
  size_t first = 0, end = 0;
  size_t count() const { return end - first; }
};

}  // namespace pelage
