// SPDX-License-Identifier: Apache-2.0
#include "base/temporary_folder.h"

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include <stdlib.h>

#include "base/error.h"

namespace pelage {
namespace {

std::filesystem::path system_folder() {
  std::error_code failure;
  std::filesystem::path folder = std::filesystem::temp_directory_path(failure);
  if (failure)
    throw Error(ErrorKind::kFailed,
                "the folder for temporary files does not exist (set TMPDIR): " + failure.message());
  return folder;
}

}  // namespace

TemporaryFolder::TemporaryFolder() : TemporaryFolder(system_folder()) {}

TemporaryFolder::TemporaryFolder(const std::filesystem::path& parent) {
  std::error_code ignored;  // mkdtemp() reports the problem
  std::filesystem::create_directories(parent, ignored);
  std::string pattern = (parent / "pelage-XXXXXX").string();
  if (!::mkdtemp(pattern.data()))
    throw Error(ErrorKind::kFailed, {parent.string(), 0, 0},
                std::string("cannot write: ") + std::strerror(errno));
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace pelage
