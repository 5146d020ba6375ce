// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <utility>
#include <vector>

namespace pelage {

/// The folder of an export. New files are made in a working folder in it. commit() moves them to their
/// places, so that a failed export leaves the folder as it was. The destructor removes the working folder; a
/// killed process leaves it, with a name that begins with ".pelage-".
///
/// A folder belongs to Pelage if its README.md says so. In other folders no file is
/// replaced.
class ExportFolder {
 public:
  /// Creates the folder and its working folder. `inputs`: files that no file of the export may replace.
  /// Throws Error: kArguments when the folder has a README.md that Pelage did not write, kFailed when a
  /// folder cannot be created.
  ExportFolder(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& inputs);
  ExportFolder(const ExportFolder&) = delete;
  ExportFolder& operator=(const ExportFolder&) = delete;
  ~ExportFolder();

  const std::filesystem::path& working() const { return working_; }
  /// Throws Error (kArguments) when `file`, relative to the folder, would replace an input, or a file in a
  /// folder that does not belong to Pelage.
  void check(const std::filesystem::path& file) const;
  /// Checks all files of the working folder, then moves them. Files that others name move before these.
  void commit();

 private:
  const std::filesystem::path folder_;
  std::set<std::pair<uint64_t, uint64_t>> inputs_;  // devices and numbers of files
  std::filesystem::path working_;
  bool is_new_ = false, is_ours_ = false;
};

}  // namespace pelage
