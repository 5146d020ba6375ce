// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace pelage {

/// Bytes allocated with operator new and not freed, and their max since reset_peak().
size_t live_bytes();
size_t peak_bytes();
void reset_peak();

}  // namespace pelage
