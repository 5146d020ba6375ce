// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"

// What is wrong with an EXR file, in our words; for the sources of image/ alone.

namespace pelage {

/// Throws Error (kInput).
[[noreturn]] void refuse_exr(const std::filesystem::path& path, const std::string& why);

/// In a handler: throws what it handles as an Error. What OpenEXR throws becomes one of `kind`: kInput where
/// a file is read, kFailed where it is written.
[[noreturn]] void rethrow_exr(const std::filesystem::path& path, ErrorKind kind);

/// Runs what may throw anything; throws nothing but Error, as rethrow_exr().
template <class Work>
auto guarded_exr(const std::filesystem::path& path, ErrorKind kind, Work&& work) {
  try {
    return work();
  } catch (...) {
    rethrow_exr(path, kind);
  }
}

}  // namespace pelage
