// SPDX-License-Identifier: Apache-2.0
#include "base/module.h"

#include <algorithm>
#include <cstdlib>
#include <system_error>
#include <vector>

#include <dlfcn.h>
#include <link.h>

#include "base/error.h"

namespace pelage {

namespace {

// Its address tells which file contains this code.
void own_address() {}

/// Returns the shared library that contains this code; empty if the executable does. The loader knows the
/// executable by an empty name, while its path in Dl_info is only what the user typed.
std::filesystem::path own_library() {
  Dl_info own{};
  link_map* file = nullptr;
  const void* address = reinterpret_cast<const void*>(&own_address);
  if (::dladdr1(address, &own, reinterpret_cast<void**>(&file), RTLD_DL_LINKMAP) == 0 || !file) return {};
  std::error_code unknown;
  return *file->l_name ? std::filesystem::canonical(file->l_name, unknown) : std::filesystem::path();
}

std::vector<std::filesystem::path> search_folders() {
  std::vector<std::filesystem::path> folders;
  std::error_code error;
  const std::filesystem::path executable = std::filesystem::read_symlink("/proc/self/exe", error);
  if (const std::filesystem::path library = own_library(); !library.empty()) {
    folders.push_back(library.parent_path());  // the executable belongs to somebody else
  } else if (!error) {
    const std::filesystem::path prefix = executable.parent_path().parent_path();
    folders.push_back(prefix / "lib");
    folders.push_back(prefix / "lib" / "pelage");
  }
  if (const char* list = std::getenv("PELAGE_MODULE_PATH")) {
    const std::string paths = list;
    for (size_t begin = 0; begin <= paths.size();) {
      const size_t end = std::min(paths.find(':', begin), paths.size());
      if (end > begin) folders.emplace_back(paths.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  return folders;
}

}  // namespace

Module::Module(const std::string& name) {
  std::string looked;
  for (const std::filesystem::path& folder : search_folders()) {
    const std::filesystem::path candidate = folder / ("lib" + name + ".so");
    std::error_code error;
    if (std::filesystem::exists(candidate, error)) {
      handle_ = ::dlopen(candidate.c_str(), RTLD_NOW | RTLD_LOCAL);
      if (!handle_) throw Error(ErrorKind::kFailed, "cannot load module " + name + ": " + ::dlerror());
      path_ = candidate;
      return;
    }
    looked += " " + candidate.string();
  }
  // Programs linked with an installed Pelage have its module folder in their run path.
  const std::string file = "lib" + name + ".so";
  handle_ = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle_) throw Error(ErrorKind::kFailed, "module " + name + " not found; searched in" + looked);
  path_ = file;
}

Module::~Module() {
  if (handle_) ::dlclose(handle_);
}

void* program_symbol(const char* name) { return ::dlsym(RTLD_DEFAULT, name); }

void* Module::symbol(const char* name) const {
  void* address = ::dlsym(handle_, name);
  if (!address) throw Error(ErrorKind::kFailed, path_.string() + " lacks the function " + name);
  return address;
}

}  // namespace pelage
