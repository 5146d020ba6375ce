// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pelage {

/// Whether a sanitizer keeps books of its own in the memory of this process, so that its resident pages say
/// little.
constexpr bool kSanitized =
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    true;
#else
    false;
#endif

/// How many of `count` equal repetitions (rays, say) a test makes. A sanitizer, which slows each of them down
/// about tenfold, looks at what they execute, not at how often: an eighth does there.
constexpr uint64_t repetitions(uint64_t count) { return kSanitized ? (count + 7) / 8 : count; }

}  // namespace pelage
