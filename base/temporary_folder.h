// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pelage {

/// Creates a new, empty folder "pelage-XXXXXX" (X: any letter or digit). The destructor removes this folder
/// and its contents, and nothing else.
class TemporaryFolder {
 public:
  /// Creates the folder in the system's folder for temporary files (TMPDIR). Throws Error (kFailed) on
  /// failure.
  TemporaryFolder();
  /// Creates the folder in `parent`. Creates `parent` too if it is missing, but never removes it. Throws
  /// Error (kFailed) on failure.
  explicit TemporaryFolder(const std::filesystem::path& parent);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace pelage
