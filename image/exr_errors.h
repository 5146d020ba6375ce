// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"

// Errors about EXR files; only for the sources of image/.

namespace pelage {

/// Throws Error (kInput).
[[noreturn]] void refuse_exr(const std::filesystem::path& path, const std::string& why);

/// Call in an exception handler: converts the current exception to an Error. Exceptions of OpenEXR become
/// errors of `kind`: kInput for reading, kFailed for writing.
[[noreturn]] void rethrow_exr(const std::filesystem::path& path, ErrorKind kind);

/// Runs `work` and converts all its exceptions with rethrow_exr().
template <class Work>
auto guarded_exr(const std::filesystem::path& path, ErrorKind kind, Work&& work) {
  try {
    return work();
  } catch (...) {
    rethrow_exr(path, kind);
  }
}

}  // namespace pelage
