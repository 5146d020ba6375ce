// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace pelage {

/// A shared library opened at run time, kept open for the lifetime of the value. Searched beside the
/// executable (../lib and ../lib/pelage), then in the folders of PELAGE_MODULE_PATH. Throws Error (kFailed)
/// naming every searched place.
class Module {
 public:
  explicit Module(const std::string& name);
  ~Module();
  Module(const Module&) = delete;
  Module& operator=(const Module&) = delete;

  /// Address of an extern "C" function. Throws Error (kFailed) when it is missing.
  void* symbol(const char* name) const;

 private:
  void* handle_ = nullptr;
  std::filesystem::path path_;
};

}  // namespace pelage
