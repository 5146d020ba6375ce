// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace pelage {

/// Heap bytes that operator new gave out and nobody gave back, and their highest value since reset_peak().
size_t live_bytes();
size_t peak_bytes();
void reset_peak();

}  // namespace pelage
