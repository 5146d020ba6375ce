// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pelage {

/// Prints the condition that failed and its position, and aborts. For bugs of the program, never for mistakes
/// of the user.
[[noreturn]] void check_failed(const char* condition, const char* file, int line);

}  // namespace pelage

/// Aborts when an invariant of the program is broken. Also active in release builds, so keep it out of hot
/// loops.
#define PELAGE_CHECK(condition) \
  (static_cast<bool>(condition) ? void(0) : ::pelage::check_failed(#condition, __FILE__, __LINE__))
