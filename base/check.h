// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pelage {

/// Prints what did not hold and where, and aborts: for bugs of ours, never for what a user did.
[[noreturn]] void check_failed(const char* condition, const char* file, int line);

}  // namespace pelage

/// Stops the program when an invariant of our own is broken. Kept in release builds: it stands outside hot
/// loops.
#define PELAGE_CHECK(condition) \
  (static_cast<bool>(condition) ? void(0) : ::pelage::check_failed(#condition, __FILE__, __LINE__))
