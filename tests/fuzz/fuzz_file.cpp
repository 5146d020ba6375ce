// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include <sys/mman.h>
#include <unistd.h>

#include "base/temporary_folder.h"
#include "tests/fuzz/fuzz_targets.h"

namespace pelage {

std::filesystem::path fuzz_file(std::span<const uint8_t> bytes, const std::string& ending) {
  // In memory, behind a link with the right name: a disk would take most of the time.
  static const TemporaryFolder folder;
  static const int file = ::memfd_create("input", MFD_CLOEXEC);
  const auto size = static_cast<ssize_t>(bytes.size());
  if (file < 0 || ::ftruncate(file, 0) != 0 || ::pwrite(file, bytes.data(), bytes.size(), 0) != size)
    std::abort();
  const std::filesystem::path path = folder.path() / ("input" + ending);
  if (!std::filesystem::is_symlink(path)) {
    std::filesystem::create_symlink("/proc/self/fd/" + std::to_string(file), path);
  }
  return path;
}

}  // namespace pelage
