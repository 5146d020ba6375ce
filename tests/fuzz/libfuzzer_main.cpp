// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/fuzz_targets.h"

// Compiled once per target, with PELAGE_FUZZ_TARGET naming its function.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  pelage::PELAGE_FUZZ_TARGET({data, size});
  return 0;
}
