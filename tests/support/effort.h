// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// 1 where the address or thread sanitizer is on, which GCC and Clang say in different ways; otherwise 0.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PELAGE_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define PELAGE_SANITIZED 1
#endif
#endif
#ifndef PELAGE_SANITIZED
#define PELAGE_SANITIZED 0
#endif

namespace pelage {

/// Whether a sanitizer uses memory of this process, so that resident pages are not meaningful.
constexpr bool kSanitized = PELAGE_SANITIZED == 1;

/// Number of equal repetitions (such as rays) in a test, out of `count`. A sanitizer slows each of them down
/// about tenfold and checks executed code, not statistics: an eighth suffices there.
constexpr uint64_t repetitions(uint64_t count) { return kSanitized ? (count + 7) / 8 : count; }

/// The same, but no fewer than `least`, which suffice for what the test requires of all of them together.
constexpr uint64_t at_least(uint64_t least, uint64_t count) {
  return repetitions(count) < least ? least : repetitions(count);
}

}  // namespace pelage
