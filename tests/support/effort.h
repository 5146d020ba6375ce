// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pelage {

/// How many of `count` equal repetitions (rays, say) a test makes. A sanitizer, which slows each of them down
/// about tenfold, looks at what they execute, not at how often: an eighth does there.
constexpr uint64_t repetitions(uint64_t count) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return (count + 7) / 8;
#else
  return count;
#endif
}

}  // namespace pelage
