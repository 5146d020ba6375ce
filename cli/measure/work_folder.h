// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pelage {

/// A new folder for what variants of an experiment hand to each other, gone with this object: nothing that
/// stood in `parent` before is touched. Throws Error (kFailed) when it cannot be made.
class WorkFolder {
 public:
  explicit WorkFolder(const std::filesystem::path& parent);
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace pelage
