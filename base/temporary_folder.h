// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pelage {

/// A new, empty folder "pelage-XXXXXX" (X: any letter or digit), removed on destruction with everything in
/// it. Does not touch anything else.
class TemporaryFolder {
 public:
  /// In the system's folder for temporary files. Throws Error (kFailed) when it cannot be created.
  TemporaryFolder();
  /// In `parent`, which is created if necessary and not removed. Throws Error (kFailed) when it cannot be
  /// created.
  explicit TemporaryFolder(const std::filesystem::path& parent);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace pelage
