// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pelage {

/// Prints the failed condition with its file and line, then aborts. For bugs of the program, never for
/// mistakes of the user.
[[noreturn]] void check_failed(const char* condition, const char* file, int line);

}  // namespace pelage

/// Aborts when `condition` is false, which means that the program has a bug. Release builds contain this
/// check too, so do not use it in hot loops.
#define PELAGE_CHECK(condition) \
  (static_cast<bool>(condition) ? void(0) : ::pelage::check_failed(#condition, __FILE__, __LINE__))
