// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace pelage {

/// A file of a page for browsers, built into the program (pelage_page() in cmake/PelageTargets.cmake).
struct PageFile {
  std::string_view name;  ///< "index.html"
  std::string_view text;
};

}  // namespace pelage
