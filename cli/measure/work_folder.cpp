// SPDX-License-Identifier: Apache-2.0
#include "cli/measure/work_folder.h"

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include <stdlib.h>

#include "base/error.h"

namespace pelage {

WorkFolder::WorkFolder(const std::filesystem::path& parent) {
  std::error_code ignored;
  std::filesystem::create_directories(parent, ignored);
  std::string pattern = (parent / "work-XXXXXX").string();
  if (!::mkdtemp(pattern.data()))
    throw Error(ErrorKind::kFailed, {parent.string(), 0, 0},
                std::string("cannot write: ") + std::strerror(errno));
  path_ = pattern;
}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace pelage
