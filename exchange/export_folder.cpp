// SPDX-License-Identifier: Apache-2.0
#include "exchange/export_folder.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/temporary_file.h"

namespace pelage {
namespace {

constexpr const char* kReadme = "README.md";

bool is_there(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::exists(std::filesystem::symlink_status(path, error));
}

/// Equal for all names of a file.
std::optional<std::pair<uint64_t, uint64_t>> identity_of(const std::filesystem::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return {};
  return std::pair<uint64_t, uint64_t>(info.st_dev, info.st_ino);
}

bool is_readme_of_pelage(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  std::ifstream file(path);
  std::string title, empty, text;
  std::getline(file, title);
  std::getline(file, empty);
  std::getline(file, text);
  return title.starts_with("# ") && empty.empty() && text.starts_with("Pelage ") &&
         text.find(" wrote these files from `") != std::string::npos;
}

[[noreturn]] void refuse_output(const std::filesystem::path& file, const std::string& why) {
  throw Error(ErrorKind::kArguments, "export: " + file.string() + ": " + why + "; choose another folder");
}

size_t depth_of(const std::filesystem::path& path) {
  return static_cast<size_t>(std::distance(path.begin(), path.end()));
}

}  // namespace

ExportFolder::ExportFolder(const std::filesystem::path& folder,
                           const std::vector<std::filesystem::path>& inputs)
    : folder_(folder), is_new_(!is_there(folder)) {
  for (const std::filesystem::path& input : inputs) {
    if (const auto identity = identity_of(input)) inputs_.insert(*identity);
  }
  const std::filesystem::path readme = folder_ / kReadme;
  is_ours_ = is_readme_of_pelage(readme);
  if (!is_ours_ && is_there(readme)) refuse_output(readme, "exists, and `pelage export` did not write it");
  make_own_folder(folder_);
  std::string name = (folder_ / (std::string(kTemporaryPrefix) + "export-XXXXXX")).string();
  if (::mkdtemp(name.data()) == nullptr)
    throw Error(ErrorKind::kFailed, "cannot create a folder in " + folder_.string());
  working_ = name;
}

ExportFolder::~ExportFolder() {
  std::error_code error;
  std::filesystem::remove_all(working_, error);
  if (is_new_) std::filesystem::remove(folder_, error);  // if it is empty
}

void ExportFolder::check(const std::filesystem::path& file) const {
  const std::filesystem::path path = folder_ / file;
  if (!is_there(path)) return;
  const auto identity = identity_of(path);
  if (identity && inputs_.contains(*identity))
    refuse_output(path, "this run would overwrite a file that it reads");
  if (!is_ours_) refuse_output(path, "exists, and no README.md of `pelage export` is beside it");
}

void ExportFolder::commit() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(working_)) {
    if (entry.is_regular_file()) files.push_back(entry.path().lexically_relative(working_));
  }
  // The README first, because it makes the folder Pelage's.
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
    if ((a == kReadme) != (b == kReadme)) return a == kReadme;
    return depth_of(a) != depth_of(b) ? depth_of(a) > depth_of(b) : a < b;
  });
  for (const std::filesystem::path& file : files) check(file);
  for (const std::filesystem::path& file : files) {
    const std::filesystem::path parent = file.parent_path();
    std::filesystem::path made = folder_;
    for (const auto& part : parent) make_own_folder(made /= part);
    std::error_code error;
    std::filesystem::rename(working_ / file, folder_ / file, error);
    if (error)
      throw Error(ErrorKind::kFailed, "cannot write " + (folder_ / file).string() + ": " + error.message());
  }
}

}  // namespace pelage
