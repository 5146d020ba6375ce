// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace pelage {

/// A loadable module: a shared library that the constructor opens and the destructor closes.
class Module {
 public:
  /// Opens lib`name`.so. Searches ../lib and ../lib/pelage beside the folder of the executable or, if this
  /// code is in a shared library, the folder of this library. Then searches the folders of the environment
  /// variable PELAGE_MODULE_PATH, the run path of this code, and the folders where the system looks for
  /// libraries. Throws Error (kFailed) when the library cannot be loaded, or when it is not found. In the
  /// latter case, the message lists all paths tried, except those of the system.
  explicit Module(const std::string& name);
  ~Module();
  Module(const Module&) = delete;
  Module& operator=(const Module&) = delete;

  /// Returns the address of an extern "C" function. Throws Error (kFailed) when the library has no such
  /// function.
  void* symbol(const char* name) const;

 private:
  void* handle_ = nullptr;
  std::filesystem::path path_;
};

/// Returns the address of a function of the program that has loaded this code, or of a library with which
/// this program was linked. Returns null if there is no function of this name.
void* program_symbol(const char* name);

}  // namespace pelage
