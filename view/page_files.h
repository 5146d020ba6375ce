// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace pelage {

/// A file of view/page/, built into the program.
struct PageFile {
  std::string_view name;  ///< "index.html"
  std::string_view text;
};

/// Returns all files of the page.
std::span<const PageFile> page_files();

}  // namespace pelage
