// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pelage {

/// A new, empty folder "pelage-XXXXXX" (X: any letter or digit), removed with everything in it at the end.
/// Nothing that stood beside it before is touched.
class TemporaryFolder {
 public:
  /// In the system's folder for temporary files. Throws Error (kFailed) when it cannot be made.
  TemporaryFolder();
  /// In `parent`, which need not exist, and stays. Throws Error (kFailed) when it cannot be made.
  explicit TemporaryFolder(const std::filesystem::path& parent);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace pelage
