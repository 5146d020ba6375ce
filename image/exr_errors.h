// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"

// Errors about EXR files. Include this header only in image/.

namespace pelage {

/// Throws Error (kInput) with the path and the reason `why`.
[[noreturn]] void refuse_exr(const std::filesystem::path& path, const std::string& why);

/// Converts the current exception to an Error and throws this Error. Call it in an exception handler. An
/// Error is rethrown unchanged. std::bad_alloc becomes kMemory. Any other exception, such as those of
/// OpenEXR, becomes `kind`: pass kInput when reading, kFailed when writing.
[[noreturn]] void rethrow_exr(const std::filesystem::path& path, ErrorKind kind);

/// Calls `work` and returns its result. Converts its exceptions with rethrow_exr().
template <class Work>
auto guarded_exr(const std::filesystem::path& path, ErrorKind kind, Work&& work) {
  try {
    return work();
  } catch (...) {
    rethrow_exr(path, kind);
  }
}

}  // namespace pelage
