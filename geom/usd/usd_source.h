// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

namespace pelage {

/// Where the root layer of a scene of USD comes from: a file, or a text in memory.
struct UsdSource {
  template <std::convertible_to<std::filesystem::path> Path>
  UsdSource(Path&& file) : path(std::forward<Path>(file)) {}
  /// `name`: for messages, and for the files that the text names. The text must outlive the scene.
  UsdSource(std::filesystem::path name, std::string_view contents) : path(std::move(name)), text(contents) {}

  std::filesystem::path path;
  std::optional<std::string_view> text;
};

}  // namespace pelage
